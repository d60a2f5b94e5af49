"""Ends of a recipe: what its ways leave that nobody wants, and in what they differ."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from arboleda.model.facts import Value, shown
from arboleda.model.plant_model import Cell

from .scene import CHANGE, HELD, LEAST, MOST, OVER, Scene


def of_ends(cell: Cell, wanted: Mapping[str, Value], ends: Sequence[Scene]) -> Iterator[str]:
    """Sentences on ways that leave something nobody wants, and on how their ends differ."""
    for end in ends:
        yield from _held(cell, wanted, end)
        yield from _left(cell, wanted, end)
        yield from _otherwise(cell, wanted, end)
    yield from _unlike(cell, wanted, ends)


def certain_ends(cell: Cell, wanted: Mapping[str, Value], ends: Sequence[Scene]) -> Iterator[str]:
    """The end that all ways have in common: as the recipe says, which is marked, then facts, parts and robots
    as its steps leave them. A device that cells share is so when the task gives it back.
    """
    sure = dict(frozenset.intersection(*(end.mark for end in ends))) if ends else {}
    for what, value in wanted.items():
        role, dot, _ = what.partition(".")
        named = cell.roles[role].name if dot else ""
        yield f"{what} {shown(value)}{_when(cell, named)} (it says so)"
    for role, device in cell.members:
        for fact in device.fact_names:
            if (device.name, fact) in sure and f"{role}.{fact}" not in wanted:
                yield f"{role}.{fact} {shown(sure[device.name, fact])}{_when(cell, device.name)}"
    for place in cell.places:
        change = int(sure.get((place.target, CHANGE)) or 0)
        if change and place.target not in wanted:
            yield f"{_parts(change)} at {place.target}"
    for space in cell.spaces:
        if (target := sure.get((space.robot.name, OVER))) is not None:
            yield f"{space.robot.name} at {target}"


def _when(cell: Cell, device: str) -> str:
    """Words for when a device is so: another cell may have a shared one before the task is over."""
    return f" when {device} is given back" if device in cell.shared else ""


def _parts(change: int) -> str:
    return f"{abs(change)} {'more' if change > 0 else 'fewer'}"


def _held(cell: Cell, wanted: Mapping[str, Value], end: Scene) -> Iterator[str]:
    for role, device in cell.members:
        if end.get(device.name, HELD) is True and f"{role}.{device.held_fact}" not in wanted:
            yield f"ends with a part that {device.name} still holds"


def _left(cell: Cell, wanted: Mapping[str, Value], end: Scene) -> Iterator[str]:
    for place in cell.places:
        change = int(end.get(place.target, CHANGE) or 0)
        if place.device is not None and not place.by_people and place.target not in wanted and change:
            yield f"ends with {_parts(change)} at {place.target} of {place.device} than it began with"


def _otherwise(cell: Cell, wanted: Mapping[str, Value], end: Scene) -> Iterator[str]:
    for what, value in wanted.items():
        role, dot, fact = what.partition(".")
        if dot:
            known = end.get(cell.roles[role].name, fact)
            if known not in (None, value):
                yield f"ends with {what} {shown(known)}, and says that it ends with {shown(value)}"
        elif (number := _unlike_number(cell, what, int(value), end)) is not None:
            yield f"ends with {what} {number}, and says that it ends with {shown(value)}"


def _unlike_number(cell: Cell, target: str, wanted: int, end: Scene) -> str | None:
    """The parts at a place in the end where these cannot be so many, whatever was there at the beginning."""
    place = next(each for each in cell.counted if each.target == target)
    if end.get(target, CHANGE) is None:
        return None
    change, least, most = (int(end.get(target, what) or 0) for what in (CHANGE, LEAST, MOST))
    first = (place.holds if place.supply else 0) if place.by_people else None
    fewest, largest = (-least, place.holds - most) if first is None else (first, first)
    if fewest + change <= wanted <= largest + change:
        return None
    if fewest == largest:
        return str(fewest + change)
    return f"at least {fewest + change}" if wanted < fewest + change else f"at most {largest + change}"


def _unlike(cell: Cell, wanted: Mapping[str, Value], ends: Sequence[Scene]) -> Iterator[str]:
    """The facts that guard something, and the places of robots, that are not the same on all ways."""
    guards = {(each.other, each.fact) for each in cell.needs}
    guards |= {(each.device, fact) for each in cell.interlocks for fact, _ in each.free_while}
    guards |= {(space.robot.name, OVER) for space in cell.spaces if space.returns}
    named = {
        (cell.roles[what.partition(".")[0]].name, what.partition(".")[2]) for what in wanted if "." in what
    }
    for name, fact in sorted(guards - named):
        found = {end.get(name, fact) for end in ends}
        if len(found) > 1 and None not in found and name not in cell.shared:
            values = " and ".join(sorted(shown(value) for value in found if value is not None))
            yield f"ends with {name} {'at' if fact == OVER else fact} {values}, by which way it goes"
