"""Packages beside the cell runner: their names, and the folders of their code."""

from __future__ import annotations

from importlib import metadata
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGES = {each.parent.name: each.parent for each in sorted(ROOT.glob("packages/*/src/*/__init__.py"))}


def leave_out(patch: pytest.MonkeyPatch, folder: Path, *packages: str) -> None:
    """Have nobody find what these packages register, as where they are not installed; `folder` is empty."""
    entry_points = metadata.entry_points

    def left() -> metadata.EntryPoints:
        found = entry_points()
        points = (each for group in found.groups for each in found.select(group=group))
        return metadata.EntryPoints(each for each in points if each.value.partition(".")[0] not in packages)

    patch.setattr(metadata, "entry_points", left)
    patch.syspath_prepend(folder)  # what is installed is read anew
