"""Files of a plant that were changed while a standby waited: what was put to work is in them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from arboleda.extension import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.model.recording import Recording
from arboleda.plant_file.draft import root_of
from arboleda.plant_file.versions import Versions
from arboleda.runtime.standing_by import ReadAgain

Read = tuple[PlantModel, Recording | None]


def is_changed(plant_file: Path | None, recording: Recording | None) -> bool:
    """True where files of a plant are others than when they were read, as far as `recording` knows them."""
    if plant_file is None or recording is None:
        return False
    Versions(plant_file).go_on()
    files = recording.files
    root = root_of(files, plant_file)
    there = {name: plant_file if name == files.plant else root / name for name in files.contents}
    return any(
        not path.is_file() or path.read_bytes() != files.contents[name] for name, path in there.items()
    )


def read_again(again: ReadAgain, before: Read, tell: Callable[[str], None]) -> Read:
    """The plant as its files have it now; where they have none, as it was `before`, which is told."""
    try:
        return again()
    except ConfigError as error:
        tell(f"the plant's files were changed, and cannot be read; this goes on with the former: {error}")
        return before
