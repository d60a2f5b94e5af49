"""Places that several cells name: the same target of a robot that these cells share."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace

from .plant_model import Cell, Place


def with_common_outputs(cells: Sequence[Cell]) -> list[Cell]:
    """The cells, where an output that is an ordinary place of another cell is one, too: what is put there
    waits for that cell, and people do not empty it for each task.
    """
    return [
        replace(cell, places=tuple(_as_others_say(place, cell, cells) for place in cell.places))
        if cell.shared_movers and any(place.output for place in cell.places)
        else cell
        for cell in cells
    ]


def _as_others_say(place: Place, cell: Cell, cells: Sequence[Cell]) -> Place:
    others = [
        each
        for other in cells
        if place.output
        for each in other.places
        if each.target in same_places(cell, place.target, other)
    ]
    waits = any(not each.by_people for each in others) and not any(each.supply for each in others)
    return replace(place, output=False) if waits else place


def with_common_places(
    parts: Mapping[str, Mapping[str, int]], cells: Iterable[Cell]
) -> dict[str, dict[str, int]]:
    """The numbers of parts at places, by cell, with those of the other cells that name the same places."""
    by_name = {cell.name: cell for cell in cells}
    everywhere = {name: dict(numbers) for name, numbers in parts.items()}
    for name, numbers in parts.items():
        others = [cell for cell in by_name.values() if not set(cell.shared).isdisjoint(by_name[name].shared)]
        for other in others:
            for target, number in numbers.items():
                for same in same_places(by_name[name], target, other):
                    everywhere.setdefault(other.name, {}).setdefault(same, number)
    return everywhere


def same_places(cell: Cell, target: str, other: Cell) -> list[str]:
    """The places of another cell that are the same as a place of this cell."""
    if cell.name == other.name:
        return []
    counted = {place.target for place in other.counted}
    names = []
    for name in set(cell.shared_movers).intersection(other.shared_movers):
        motion, here = cell.reach[name].robot.motion, cell.reach[name].targets.get(target)
        for each, pose in other.reach[name].targets.items():
            if here is not None and each in counted and motion.stands_at(here.q, pose.q):
                names.append(each)
    return names


def room_at(cell: Cell, target: str, cells: Collection[Cell]) -> int:
    """The number of parts that a place of a cell holds; the least that any of `cells` says of that place."""
    names = {(other.name, same) for other in cells for same in same_places(cell, target, other)}
    names.add((cell.name, target))
    return min(each.holds for other in cells for each in other.counted if (other.name, each.target) in names)
