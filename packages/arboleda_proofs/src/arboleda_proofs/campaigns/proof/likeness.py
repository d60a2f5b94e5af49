"""Likeness of a world: all that it refers to and that what follows may depend on, as hashes.

Numbers that only grow, and that are only compared with each other, count by their order.
"""

from __future__ import annotations

import functools
import types
from collections import deque
from collections.abc import Hashable, Iterator
from enum import Enum
from itertools import count, zip_longest
from random import Random
from typing import Any

from py_trees.behaviour import Behaviour

from arboleda.drivers import DeviceKind, Robot
from arboleda.engine import Belief, Entry, Plant
from arboleda.engine.inspection import Ledger, News, ReportMoment, beliefs_of
from arboleda.extension import Phrase
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.recipes import Recipe
from arboleda.rig.network import Client, Line
from arboleda.rig.world import World
from arboleda.sim.board import Board
from arboleda.sim.freshness import Freshness
from arboleda.wire.board_reports import BoardReports
from arboleda.wire.bridge import Bridge

from .growing_numbers import REPORTS, TELEMETRY, GrowingNumber, Ranks, growing

Likeness = tuple[int, ...]
NOTHING: frozenset[str] = frozenset()
PLAIN = (type(None), bool, int, float, str, bytes, Enum)
STATIC = (PlantModel, Cell, Robot, Recipe, DeviceKind, Phrase, type, types.ModuleType)
"""Types of the plant file and of the code: their values are the same in all runs of a process."""
LEFT_OUT: dict[type, frozenset[str]] = {
    World: frozenset(
        {
            "watchers",  # who only looks: the stage and the judges
            "before_asking",
            "moment",  # empty between two steps
            "faults_active",  # asked by whoever compares
            "last_fault_at",  # for judges: how much they excuse
            "deceptions",
            "holds",
            "_agenda",  # said by `to_come`
            "turns",  # the order of what is to come at one time, which that keeps
        }
    ),
    Plant: frozenset({"revisions"}),  # numbers that say to a page that there is something new
    News: frozenset({"changes"}),
    Ledger: frozenset({"version"}),
    Belief: frozenset({"rate"}),  # how often a board speaks, which is shown and no more
    Entry: frozenset({"accepted_at", "observations"}),  # said by `_parts`, as far as it is asked for
    Freshness: frozenset({"_marks"}),  # said by `_parts`
    Board: frozenset({"refusals"}),  # for people
    Bridge: frozenset({"_strays"}),  # what was refused, for people
    BoardReports: frozenset({"counters"}),
    Behaviour: frozenset({"id", "logger"}),  # drawn anew for each tree; for people
    Line: frozenset({"busy_until"}),  # said as how long that still is
    Client: frozenset({"queue"}),  # said by `_parts` while something is under way, which names its queue
}
"""Attributes by class that say nothing of what follows, and why. All others count."""


def likeness(world: World) -> Likeness:
    """Likeness of a world: another one of this process with the same does the same from now on, if the same
    is done to it.
    """
    return tuple(_words(world))


def first_difference(world: World, known: Likeness) -> int | None:
    """The number of the first word in which a world is unlike; None where it has this likeness.

    It takes as long as that number is high: words are found one by one.
    """
    found = enumerate(zip_longest(_words(world), known))
    return next((number for number, (one, other) in found if one != other), None)


def _words(world: World) -> Iterator[int]:
    """A hash for each thing to which a world refers, and then for the order of growing numbers.

    What a fault leaves behind most often comes first.
    """
    plant = world.plant
    found: list[Any] = [beliefs_of(plant), world.boards, world.bridge, world, world.to_come]
    numbers = {id(each): number for number, each in enumerate(found)}  # `found` keeps them: no other gets one
    robots = {robot.mqtt: robot.name for robot in world.model.robots.values()}
    robots |= {name: name for name in world.model.robots}
    owners, ranks = [""] * len(found), Ranks()
    for place, whole in enumerate(found):  # which grows meanwhile
        words: list[Hashable] = []
        owner, is_table = owners[place], isinstance(whole, dict)
        for part in _parts(whole, world.now):
            if isinstance(part, PLAIN):
                words.append(part)
            elif isinstance(part, GrowingNumber):
                ranks.note(owner, part)
            elif isinstance(part, STATIC):
                words.append(_name(part))
            elif id(part) in numbers:
                words.append((numbers[id(part)],))
            else:
                key = words[-1] if is_table and words else ""
                numbers[id(part)] = len(found)
                found.append(part)
                owners.append(_owner(part) or owner or robots.get(key, "") if isinstance(key, str) else owner)
                words.append(type(part).__qualname__)
        yield hash(repr(words))
    yield hash(repr([*ranks]))


def _owner(part: Any) -> str:
    """The name of the robot that something is about; empty where it does not say."""
    if hasattr(type(part), "__getattr__"):  # a handle of a recipe: it makes its attributes up
        return ""
    robot = getattr(part.command if isinstance(part, Entry) else part, "robot", "")
    return robot.name if isinstance(robot, Robot) else robot if isinstance(robot, str) else ""


def _name(static: Any) -> str:
    names = (getattr(static, name, None) for name in ("key", "name", "__qualname__"))
    return str(next((name for name in names if name), type(static).__name__))


def _parts(whole: Any, now: float) -> Iterator[Any]:
    """All that something refers to itself, in an order of its own."""
    if isinstance(whole, dict):
        for pair in whole.items():
            yield from pair
    elif isinstance(whole, ReportMoment):
        yield from (GrowingNumber(REPORTS, whole.reports), whole.at)
    elif isinstance(whole, list | tuple | deque):
        yield from whole
    elif isinstance(whole, set | frozenset):
        yield from sorted(map(repr, whole))
    elif isinstance(whole, types.FunctionType):
        yield whole.__qualname__
        yield from (cell.cell_contents for cell in whole.__closure__ or ())
    elif isinstance(whole, types.MethodType):
        yield from (whole.__func__.__qualname__, whole.__self__)
    elif isinstance(whole, functools.partial):
        yield from (whole.func, whole.args, whole.keywords)
    elif isinstance(whole, types.GeneratorType):
        frame = whole.gi_frame
        yield from (whole.__qualname__, -1 if frame is None else frame.f_lasti)
        yield from () if frame is None else frame.f_locals.values()
    elif isinstance(whole, count | Random):
        yield repr(whole) if isinstance(whole, count) else whole.getstate()
    elif isinstance(whole, Line):
        yield max(0.0, whole.busy_until - now)
    elif isinstance(whole, Client):
        yield 0 if whole.down.is_clear(now) else whole.queue
    elif isinstance(whole, Entry):
        yield from (whole.accepted_at is None, whole.observations) if whole.open else ()
    elif isinstance(whole, Freshness):
        for at, number in whole.marks:
            yield from (at, GrowingNumber(TELEMETRY, number))
    kind: type = type(whole)
    slots, left_out = _attributes(kind)
    for name in slots:
        if hasattr(whole, name):
            yield from (name, growing(whole, name, getattr(whole, name)))
    for name, value in getattr(whole, "__dict__", {}).items():
        if name not in left_out:
            yield from (name, growing(whole, name, value))


@functools.cache
def _attributes(kind: type) -> tuple[tuple[str, ...], frozenset[str]]:
    """The slots of a class and its bases that count, and the names that do not.

    Python has private slots under another name.
    """
    found, left_out = [], NOTHING.union(*(LEFT_OUT.get(base, NOTHING) for base in kind.__mro__))
    for base in kind.__mro__:
        slots = getattr(base, "__slots__", ())
        for name in (slots,) if isinstance(slots, str) else slots:
            is_private = name.startswith("__") and not name.endswith("__")
            found.append(f"_{base.__name__.lstrip('_')}{name}" if is_private else name)
    return tuple(name for name in found if name not in {*left_out, "__dict__", "__weakref__"}), left_out
