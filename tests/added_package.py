"""Packages of somebody else that add parts to a plant, installed in a folder of a test."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from importlib import invalidate_caches
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
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{package}.py").write_text(code, "utf-8")
    register(folder, package, {group: [f"{package} = {package}:{what}"]})


def register(folder: Path, package: str, entry_points: Mapping[str, Sequence[str]]) -> None:
    """Have a package found by these entry points, of each group, as `setup.py` writes them."""
    about = folder / f"{package}-1.dist-info"
    about.mkdir(parents=True)
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1\n", "utf-8")
    groups = (f"[{group}]\n" + "\n".join(lines) for group, lines in entry_points.items())
    (about / "entry_points.txt").write_text("\n".join(groups), "utf-8")
    later = folder.stat().st_mtime_ns + 10**9  # however coarse the clock of the disk is
    os.utime(folder, ns=(later, later))
    invalidate_caches()  # two packages that come within one tick of that clock have the same time
