"""The examples that come with Arboleda: whole cells, a folder each."""

from __future__ import annotations

from importlib.resources import files
from itertools import takewhile
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from importlib.abc import Traversable  # where Python 3.10 has it, and 3.14 no more

PLANT = "plant.yaml"
NAMED = "NAME"  # in the files of the starter, for the name of the plant or package that is written


def folders() -> dict[str, Traversable]:
    """The folder of each example, by its name."""
    entries = files("arboleda").joinpath("examples").iterdir()
    return {each.name: each for each in sorted(entries, key=_name) if each.joinpath(PLANT).is_file()}


def about(example: Traversable) -> str:
    """The comment at the beginning of an example's plant file."""
    lines = example.joinpath(PLANT).read_text("utf-8").splitlines()
    return " ".join(line.lstrip("# ") for line in takewhile(lambda line: line.startswith("#"), lines))


def texts(folder: Traversable, under: str = "") -> dict[str, str]:
    """The contents of an example's files, by their paths in it."""
    held: dict[str, str] = {}
    for each in sorted(folder.iterdir(), key=_name):
        if each.is_file():
            held[under + each.name] = each.read_text("utf-8")
        elif each.name != "__pycache__":
            held |= texts(each, f"{under}{each.name}/")
    return held


def _name(entry: Traversable) -> str:
    return str(entry.name)
