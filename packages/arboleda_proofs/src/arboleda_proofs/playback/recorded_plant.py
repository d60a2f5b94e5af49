"""The plant of a record, made once more from the files that are in it, or from others in their place."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path, PurePosixPath

from arboleda.extension import ConfigError
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import Link, PlantModel
from arboleda.plant_file import loader
from arboleda.recorder.errors import NoRecord
from arboleda.recorder.preamble import Beginning
from arboleda.recorder.reader import Record
from arboleda.recorder.version_files import versions_in
from arboleda.runtime.rate import at_rate
from arboleda_proofs.campaigns.plant_reading import read_from
from arboleda_proofs.campaigns.plants import ELSEWHERE


def model_of(beginning: Beginning, other: Path | None = None) -> PlantModel:
    """The plant of the record, or of another plant file in its place; NoRecord, ConfigError."""
    if other is not None:
        return as_it_ran(beginning, loader.load(other))
    try:
        return as_it_ran(beginning, loaded(beginning.files))
    except ConfigError as error:
        raise NoRecord(f"The plant file of the record cannot be read by this version:\n{error}") from error


def as_it_ran(beginning: Beginning, model: PlantModel) -> PlantModel:
    """The same plant with the boards and at the rate of the recorded run."""
    if beginning.simulated:
        return model.on_boards(*ELSEWHERE)
    return at_rate(model.on_boards(Link.DRIVER) if beginning.virtual else model, beginning.rate)


def versions_of(record: Record) -> dict[str, PlantModel]:
    """The versions that the plant of a record took while it ran, by digest; NoRecord."""
    beginning = record.first.beginning
    try:
        found = versions_in(record.paths).items()
        return {digest: as_it_ran(beginning, loaded(files)) for digest, files in found}
    except ConfigError as error:
        raise NoRecord(
            f"A version of the plant in the record cannot be read by this version:\n{error}"
        ) from error


def with_content(files: PlantFiles, name: str, content: bytes) -> PlantFiles:
    """The same files, one of them with another content."""
    return replace(files, contents={**files.contents, name: content})


def loaded(files: PlantFiles) -> PlantModel:
    """The plant that these files of a record describe; NoRecord, ConfigError with every problem."""
    for name in (files.plant, *files.contents):
        path = PurePosixPath(name)
        if path.is_absolute() or ".." in path.parts or not path.parts or "\0" in name:
            raise NoRecord("Its plant file has a path that no plant writes.")
    return read_from(files)
