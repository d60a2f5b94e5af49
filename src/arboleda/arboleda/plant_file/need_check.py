"""Check of needs: facts that a device never reports, so that a verb which needs them is always refused."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from arboleda.model.plant_model import Cell, Evidence, PlantModel


def warnings(plant: PlantModel) -> tuple[str, ...]:
    """A sentence for each verb that is always refused, as a fact that it needs is never reported."""
    return tuple(f"{cell.name}: {sentence}" for cell in plant.cells for sentence in _unmet(cell))


def _unmet(cell: Cell) -> Iterator[str]:
    silent = {each.name for each in cell.robots if each.evidence is Evidence.STATE}
    for device, word, other, fact in (*_own(cell), *_of_others(cell)):
        if other in silent:
            why = f"{other} reports no facts (evidence: state)"
            yield f"{device} {word} needs {fact} of {other}, and {why}; it is always refused"


def _own(cell: Cell) -> Iterator[tuple[str, str, str, str]]:
    devices: list[Any] = [each for each in cell.robots if each.verb_names]
    for device in devices:
        for verb in device.kind.verbs.values():
            yield from ((device.name, verb.name, device.name, fact) for fact, _ in verb.needs)


def _of_others(cell: Cell) -> Iterator[tuple[str, str, str, str]]:
    yield from ((each.device, each.word, each.other, each.fact) for each in cell.needs)
