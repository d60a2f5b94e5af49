"""A plant that is read from the content of its files, which came from elsewhere."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from arboleda.extension import ConfigError
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader

ABSOLUTE = "the plant file uses files by absolute paths, which are others here"


def read_from(files: PlantFiles) -> PlantModel:
    """The plant that these files describe, in a folder of their own; ConfigError with every problem."""
    with TemporaryDirectory(prefix="arboleda-") as made:
        for name, content in files.contents.items():
            path = Path(made, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        model, read = loader.load_with_files(Path(made, files.plant))
    if sorted(read.contents.values()) != sorted(files.contents.values()):
        raise ConfigError((ABSOLUTE,))
    return model
