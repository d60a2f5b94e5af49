"""Files that the last start of a plant was made of, kept in its state directory beside what it remembers."""

from __future__ import annotations

import shutil
from pathlib import Path

from arboleda.plant_file import versions
from arboleda.plant_file.versions import Version, version_of
from arboleda.recorder.preamble import PlantFiles

FOLDER = "at_work"


def keep(state: Path, files: PlantFiles | None, at: str) -> None:
    """Keep what a start is made of, `at` in UTC, and nothing if that is not known; StartError if the disk
    refuses."""
    folder = state / FOLDER
    shutil.rmtree(folder, ignore_errors=True)
    if files is not None:
        # A start waits for no disk here: what a power cut takes, the next start writes again.
        versions.write(folder, version_of(files, at=at), syncs=False)


def known(state: Path) -> Version | None:
    """What the last start of a plant was made of; None if none was kept."""
    return versions.read(state / FOLDER) if (state / FOLDER).is_dir() else None
