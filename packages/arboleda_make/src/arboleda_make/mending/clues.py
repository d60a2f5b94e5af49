"""Clues: the names that findings say, by which what is likely to mend them is tried first."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from typing import Any

from arboleda.model.plant_model import Cell, PlantModel
from arboleda.plant_check.findings import PlantFinding

WORD = re.compile(r"[A-Za-z_]\w*")
NUMBER = re.compile(r"(?<![\w.])\d[\d,]*(?:\.\d+)?(?![\w])")
QUOTED = re.compile(r"""['"]([^'"]+)['"]""")
MEANT = re.compile(r"""did you mean ['"]?([\w.]+)""")


def words_of(text: str) -> frozenset[str]:
    """All names in a text."""
    return frozenset(WORD.findall(text))


@dataclass(frozen=True, kw_only=True)
class Clues:
    """Clues of some findings, the first of which counts most: the text of all, names of the plant in it."""

    first: PlantFinding
    text: str
    names: frozenset[str]

    def count(self, words: Collection[str]) -> int:
        """The number of these names that the findings have."""
        return len(self.names.intersection(words))

    def says(self, *words: str) -> bool:
        """True where the findings have one of these words."""
        return any(word in self.text for word in words)

    @property
    def quoted(self) -> tuple[str, ...]:
        """The words in quotes."""
        return tuple(dict.fromkeys(QUOTED.findall(self.text)))

    @property
    def meant(self) -> tuple[str, ...]:
        """The words that were probably meant."""
        return tuple(dict.fromkeys(MEANT.findall(self.text)))

    @property
    def numbers(self) -> tuple[float, ...]:
        """The numbers."""
        return tuple(dict.fromkeys(float(each.replace(",", "")) for each in NUMBER.findall(self.text)))


def clues_of(findings: Iterable[PlantFinding], model: PlantModel | None) -> Clues:
    """The clues of findings, the first of which are the ones to mend."""
    listed = list(findings)
    alike = [each for each in listed if each.source is listed[0].source][:4]
    text = "\n".join(each.sentence for each in alike)
    words = words_of(text)
    known = words if model is None else words & frozenset(_names(model))
    return Clues(first=listed[0], text=text, names=known)


def _names(model: PlantModel) -> Iterable[str]:
    for cell in model.cells:
        yield from of_cell(cell)


def of_cell(cell: Cell) -> Iterable[str]:
    """The names that a cell has for anything."""
    for role, robot in cell.members:
        device: Any = robot
        yield from (role, device.name, *device.verb_names, *device.fact_names)
        if device.verb_names:
            yield from (str(word) for each in device.kind.facts.values() for word in each.words)
    for space in cell.spaces:
        yield from space.targets
    yield from (each.name for each in cell.recipes)
