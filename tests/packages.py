"""Packages beside the cell runner: their names, and the folders of their code."""

from __future__ import annotations

from importlib import metadata
from pathlib import Path

import pytest

from arboleda.cli.commands import commands
from arboleda.dashboard.findings import findings, step_names
from arboleda.dashboard.wording import words
from arboleda.web.languages import contents, texts

ROOT = Path(__file__).parents[1]
PACKAGES = {each.parent.name: each.parent for each in sorted(ROOT.glob("packages/*/src/*/__init__.py"))}
CACHES = (commands, contents, texts, words, findings, step_names)


class MadeOnce:
    """What is made once of all that is installed: a patch of it has it made anew, and so has its end."""

    left_out: tuple[str, ...] = ()

    def __setattr__(self, name: str, value: object) -> None:
        forget()

    def __delattr__(self, name: str) -> None:
        forget()


def forget() -> None:
    """Have what is made once made anew."""
    for each in CACHES:
        each.cache_clear()


def leave_out(patch: pytest.MonkeyPatch, folder: Path, *packages: str) -> None:
    """Have nobody find what these packages register, as where they are not installed; `folder` is empty."""
    entry_points = metadata.entry_points
    patch.setattr(MadeOnce(), "left_out", packages)

    def left(**wanted: str) -> metadata.EntryPoints:
        found = entry_points()
        points = (each for group in found.groups for each in found.select(group=group))
        kept = (each for each in points if each.value.partition(".")[0] not in packages)
        return metadata.EntryPoints(kept).select(**wanted)

    patch.setattr(metadata, "entry_points", left)
    patch.syspath_prepend(folder)  # what is installed is read anew
