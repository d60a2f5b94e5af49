"""Files that are at work: those of a plant's last start, or put to work since, in its state directory."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from arboleda.model.errors import StartError
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file import versions
from arboleda.plant_file.not_installed import FILE as PACKAGES
from arboleda.plant_file.versions import Version, version_of

from .state import default_state, replace_file

FOLDER, FRESH = "at_work", "at_work.new"  # the second for a moment only, in which the first may be gone


def keep(state: Path, files: PlantFiles | None, at: str) -> None:
    """Keep what is at work, `at` in UTC, and nothing if that is not known; StartError if the disk
    refuses."""
    folder, fresh = state / FOLDER, state / FRESH
    shutil.rmtree(fresh, ignore_errors=True)
    if files is not None:
        # A start waits for no disk here: what a power cut takes, the next start writes again.
        versions.write(fresh, version_of(files, at=at), syncs=False)
    shutil.rmtree(folder, ignore_errors=True)
    if files is not None:
        fresh.rename(folder)


def keep_brought(plant: str, brought: Mapping[str, Mapping[str, str]]) -> None:
    """Keep which packages bring what of the plant; a start goes on where the disk refuses.

    It is kept in the default state directory also where the state is elsewhere: `check` knows no other.
    """
    file = default_state(plant) / PACKAGES
    with suppress(OSError):
        if brought or file.exists():
            file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            replace_file(file, json.dumps(brought))


def version(state: Path) -> Version | None:
    """The version at work in a plant, or the last one; None if none was kept."""
    for folder in (state / FRESH, state / FOLDER):  # of which a kill may have left one half deleted
        with suppress(StartError):
            return versions.read(folder)
    return None
