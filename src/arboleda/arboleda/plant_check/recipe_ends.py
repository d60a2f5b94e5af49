"""Ends of a recipe: parts and facts that its paths leave and nobody wants, and differences between ends."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import partial

from arboleda.model.facts import Value, shown
from arboleda.model.plant_model import Cell
from arboleda.model.recipe import End, in_common, nearest

from .foresight import ANSWER, CHANGE, HAD, HELD, LEAST, MOST, OVER, Scene, SceneKey
from .notation import Notation

Wanted = Mapping[str, Value]
"""An end that a recipe states; of several one is so."""


def of_ends(notation: Notation, stated: Sequence[Wanted], ends: Sequence[Scene]) -> Iterator[str]:
    """Sentences on ends of paths that nobody wants, and on differences between them."""
    for end in ends:
        wanted = nearest(stated, partial(_differs, notation.cell, end))
        yield from _held(notation, wanted, end)
        yield from _changed_places(notation, wanted, end)
        yield from _otherwise(notation, wanted, end)
    yield from _unlike(notation, {what for wanted in stated for what in wanted}, ends)


def met(cell: Cell, stated: Sequence[Wanted], ends: Sequence[Scene]) -> set[int]:
    """The numbers of those ends of a recipe with which a path may end."""
    return {
        number
        for number, wanted in enumerate(stated)
        if any(not any(_differs(cell, end, *each) for each in wanted.items()) for end in ends)
    }


def never_met(stated: Sequence[End], numbers: Collection[int]) -> Iterator[str]:
    """Sentences on those of several stated ends, all but those with these numbers, that no path has."""
    for number, end in enumerate(stated if len(stated) > 1 else ()):
        if number not in numbers:
            yield f"says that it may end with {_in_words(dict(end))}, and never ends so"


def certain_ends(cell: Cell, stated: Sequence[Sequence[Wanted]], ends: Sequence[Scene]) -> Iterator[str]:
    """The facts that all paths end with: those that the recipe states, then those that its steps leave.

    `stated` has the ends by each set of values. The facts of a device that cells share are those when the
    task gives the device back; a task that never takes the device leaves it as other cells do.
    """
    sure = dict(frozenset.intersection(*(end.mark for end in ends))) if ends else {}
    wanted = in_common([each for one in stated for each in one])
    for what, value in wanted.items():
        role, dot, _ = what.partition(".")
        named = cell.roles[role].name if dot else ""
        yield f"{what} {shown(value)}{_when(cell, named, sure)} (it says so)"
    if len(stated[0]) > 1 and all(each == stated[0] for each in stated):
        ways = ({what: way[what] for what in way if what not in wanted} for way in stated[0])
        yield f"{' or '.join(map(_in_words, ways))} (it says so)"
    for role, device in cell.members:
        for fact in device.fact_names:
            if (device.name, fact) in sure and f"{role}.{fact}" not in wanted:
                yield f"{role}.{fact} {shown(sure[device.name, fact])}{_when(cell, device.name, sure)}"
    for place in cell.places:
        change = int(sure.get((place.target, CHANGE)) or 0)
        if change and place.target not in wanted:
            yield f"{_parts(change)} at {place.target}"
    for space in cell.spaces:
        if (target := sure.get((space.robot.name, OVER))) is not None:
            yield f"{space.robot.name} at {target}"


def _when(cell: Cell, device: str, sure: Mapping[SceneKey, Value]) -> str:
    """Words for the moment at which a fact counts: another cell may use a shared device before the end."""
    if device not in cell.shared:
        return ""
    given_back = f" when {device} is given back"
    return given_back if (device, HAD) in sure else f"{given_back}, by a task that takes it"


def _parts(change: int) -> str:
    return f"{abs(change)} {'more' if change > 0 else 'fewer'}"


def _held(notation: Notation, wanted: Mapping[str, Value], end: Scene) -> Iterator[str]:
    for role, device in notation.cell.members:
        fact = f"{role}.{device.held_fact}"
        if end.get(device.name, HELD) is True and fact not in wanted:
            yield f"ends with a part that {device.name} still holds" + notation.states(fact, True)


def _changed_places(notation: Notation, wanted: Mapping[str, Value], end: Scene) -> Iterator[str]:
    for place in notation.cell.places:
        change, least = (int(end.get(place.target, what) or 0) for what in (CHANGE, LEAST))
        if place.device is not None and not place.by_people and place.target not in wanted and change:
            more = f"ends with {_parts(change)} at {place.target} of {place.device} than it began with"
            yield more + notation.states(place.target, change - least)


def _otherwise(notation: Notation, wanted: Mapping[str, Value], end: Scene) -> Iterator[str]:
    cell = notation.cell
    for what, value in wanted.items():
        if "." in what:
            actual = end.get(*_key(cell, what))
            if actual not in (None, value):
                says = f"ends with {what} {shown(actual)}, and says that it ends with {shown(value)}"
                yield says + notation.states(what, actual)
        elif (number := _unlike_number(cell, what, int(value), end)) is not None:
            says = f"ends with {what} {number}, and says that it ends with {shown(value)}"
            yield says + (notation.states(what, int(number)) if number.isdecimal() else "")


def _differs(cell: Cell, end: Scene, what: str, value: Value) -> bool:
    """True where it is certain that a place, a fact or an answer is not so at the end of a path."""
    if "." in what:
        return end.get(*_key(cell, what)) not in (None, value)
    return _unlike_number(cell, what, int(value), end) is not None


def _key(cell: Cell, what: str) -> SceneKey:
    """The key of a fact, as `reader.lid`, or of the last answer of a device, as `camera.look`."""
    role, _, word = what.partition(".")
    device = cell.roles[role]
    return device.name, word if word in device.fact_names else word + ANSWER


def _in_words(wanted: Wanted) -> str:
    return " and ".join(f"{what} {shown(value)}" for what, value in wanted.items())


def _unlike_number(cell: Cell, target: str, wanted: int, end: Scene) -> str | None:
    """The possible numbers of parts at a place in the end, in words; None where `wanted` is one of them."""
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


def _unlike(notation: Notation, wanted: Collection[str], ends: Sequence[Scene]) -> Iterator[str]:
    """The facts that guard something, and the targets of robots, that differ between the ends."""
    cell = notation.cell
    guards = {(each.other, each.fact) for each in cell.needs}
    guards |= {(each.device, fact) for each in cell.interlocks for fact, _ in each.free_while}
    guards |= {(space.robot.name, OVER) for space in cell.spaces if space.returns}
    named = {
        (cell.roles[what.partition(".")[0]].name, what.partition(".")[2]) for what in wanted if "." in what
    }
    for name, fact in sorted(guards - named):
        values_at_ends = {end.get(name, fact) for end in ends}
        if len(values_at_ends) > 1 and None not in values_at_ends and name not in cell.shared:
            values = sorted((value for value in values_at_ends if value is not None), key=shown)
            step = notation.home(name) if fact == OVER else notation.sets(name, fact, values[0])
            advice = f"; write {step} on each way" if step else ""
            what = "at" if fact == OVER else fact
            yield f"ends with {name} {what} {' and '.join(map(shown, values))}, by which way it goes" + advice
