"""Packages of somebody else that add parts to a plant, installed in a folder of a test."""

from __future__ import annotations

import os
from pathlib import Path

COUNTER = """
from arboleda.runtime.parts.orchestrator import Orchestrator
from arboleda.runtime.registry import Factory, Phase

HEARD = []


class Counter:
    notes = ["Counter: it counts"]

    def start(self):
        HEARD.append("start")

    def stop(self):
        HEARD.append("stop")


def counter(assembly):
    part = Counter()
    assembly.offer(Counter, part)
    assembly.notes.append(lambda: part.notes)
    assembly.need(Orchestrator).listeners.append(HEARD.append)
    yield part


PARTS = [Factory(phase=Phase.VIEWS, make=counter)]
"""


def install(
    folder: Path, package: str, code: str, *, group: str = "arboleda.parts", what: str = "PARTS"
) -> None:
    """Install a package of one module, which registers `what` of that under its own name."""
    about = folder / f"{package}-1.dist-info"
    about.mkdir(parents=True)
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1\n", "utf-8")
    (about / "entry_points.txt").write_text(f"[{group}]\n{package} = {package}:{what}\n", "utf-8")
    (folder / f"{package}.py").write_text(code, "utf-8")
    later = folder.stat().st_mtime_ns + 10**9  # however coarse the clock of the disk is
    os.utime(folder, ns=(later, later))
