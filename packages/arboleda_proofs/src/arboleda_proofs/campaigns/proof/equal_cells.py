"""Equal cells: those that differ in nothing but their names and those of their own devices."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import fields, is_dataclass

from arboleda.model.plant_model import Cell, PlantModel


def equal_cells(model: PlantModel) -> dict[str, str]:
    """For each cell the first one that is equal to it, by their names."""
    firsts: dict[Hashable, str] = {}
    return {cell.name: firsts.setdefault(_unnamed(cell), cell.name) for cell in model.cells}


def notes(model: PlantModel) -> Iterator[str]:
    """A line for each cell that others are equal to."""
    firsts = equal_cells(model)
    for first in dict.fromkeys(firsts.values()):
        others = [name for name, like in firsts.items() if like == first != name]
        if others:
            yield f"equal to {first} but for names, so proved once, in {first}: {', '.join(others)}"


def _unnamed(cell: Cell) -> Hashable:
    """All of a cell, with roles for the names of its own devices."""
    own = {robot.name: role for role, robot in cell.members if robot.name in cell.own}
    boards = {robot.mqtt: role for role, robot in cell.members if robot.name in cell.own}
    return _with(boards | own | {cell.name: ""}, cell)


def _with(names: Mapping[str, str], value: object) -> Hashable:
    """A value as one that can be compared, with other names."""
    if isinstance(value, str):
        return type(value), names.get(value, value)
    if is_dataclass(value) and not isinstance(value, type):
        shown = [each.name for each in fields(value) if each.compare]
        return type(value), tuple(_with(names, getattr(value, each)) for each in shown)
    if isinstance(value, Mapping):
        return frozenset((_with(names, key), _with(names, each)) for key, each in value.items())
    if isinstance(value, list | tuple):
        return tuple(_with(names, each) for each in value)
    if isinstance(value, set | frozenset):
        return frozenset(_with(names, each) for each in value)
    return value if isinstance(value, Hashable) else id(value)
