"""Building of a plant from the texts of its files, as a person has edited them in the tab."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from arboleda.extension import ConfigError
from arboleda.geometry import bodies
from arboleda.geometry.bodies import Body
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader
from arboleda.plant_file.urdf import robot_urdf
from arboleda_proofs.campaigns.plants import Plant

PLANT = "plant.yaml"
PROBLEM = re.compile(r"(?P<file>[^:\n]+):(?P<line>\d+)(?::\d+)?: (?P<text>.*)", re.DOTALL)
Texts = Mapping[str, str]  # of files, by their paths from the folder that holds them


@contextmanager
def written(texts: Texts) -> Iterator[Path]:
    """A folder with these files, for as long as it is used."""
    with TemporaryDirectory(prefix="arboleda-") as made:
        folder = Path(made)
        for name, text in texts.items():
            file = folder / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, "utf-8", newline="")
        yield folder


def built(texts: Texts, plant: str) -> tuple[PlantModel, dict[str, Body]]:
    """The plant with virtual boards alone, and the bodies of its robots; ConfigError with what is wrong."""
    with written(texts) as folder:
        try:
            model = Plant(declared=loader.load(folder / plant)).model
            return model, drawings(model)
        except ConfigError as error:
            raise ConfigError(tuple(each.replace(f"{folder}/", "") for each in error.problems)) from error
        except SystemExit as end:
            raise ConfigError((f"a Python file of the plant ends Python, with status {end.code}",)) from end


def drawings(model: PlantModel) -> dict[str, Body]:
    """The bodies of the robots that the twin draws."""
    drawn = [robot.name for robot in model.robots.values() if robot.drawn() is not None]
    return {each: bodies.read(robot_urdf(model, each)) for each in drawn}


def problem(sentence: str) -> dict[str, Any]:
    """A problem as {file, line, text}: the line 0 where it names none."""
    found = PROBLEM.fullmatch(sentence)
    if found is None:
        return {"file": "", "line": 0, "text": sentence}
    return {"file": found["file"], "line": int(found["line"]), "text": found["text"]}
