"""Growing numbers of a world that are only compared with each other: their order counts, not their value."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from arboleda.drivers import Command, Report
from arboleda.engine import Belief
from arboleda.engine.inspection import SETTLES_IN, Stillness
from arboleda.sim.freshness import Freshness
from arboleda.sim.uplink import Uplink
from arboleda.wire.link import BoardLink
from arboleda.wire.values import EffectorGoal, HomeGoal, JointsGoal, PathGoal, VerbGoal

REPORTS = "reports"  # of a robot that have reached the plant
TELEMETRY = "telemetry"  # of a board since its boot


class GrowingNumber(NamedTuple):
    """Number that a count of a `sort` had when it was noted; `counts`: the count itself, above all others."""

    sort: str
    value: int
    counts: bool = False


COUNTED, NOTED = (REPORTS, True), (REPORTS, False)
TOLD, HEARD = (TELEMETRY, True), (TELEMETRY, False)
SORTS: dict[type, dict[str, tuple[str, bool]]] = {
    Belief: {
        "reports": COUNTED,
        "facts_no": NOTED,
        "number": HEARD,
    },
    Stillness: {"_position_no": NOTED, "_state_no": NOTED, "_still_from": NOTED, "_rested_from": NOTED},
    Uplink: {"sent": TOLD},
    Freshness: {"_last_number": HEARD},
    BoardLink: {"number": HEARD},
    Report: {"number": HEARD},
    Command: {"heard": HEARD},
    JointsGoal: {"heard": HEARD},
    PathGoal: {"heard": HEARD},
    EffectorGoal: {"heard": HEARD},
    HomeGoal: {"heard": HEARD},
    VerbGoal: {"heard": HEARD},
}
"""Attributes with such numbers by class: nobody reads them but to ask which one is higher."""


def growing(holder: object, name: str, value: object) -> object:
    """The value of an attribute: a growing number as such, and of repeats as many as anybody asks for."""
    if isinstance(value, int):
        for base in type(holder).__mro__:
            if (sort := SORTS.get(base, {}).get(name)) is not None:
                return GrowingNumber(sort[0], value, sort[1])
        if name == "repeats" and isinstance(holder, Belief):
            return min(value, SETTLES_IN)
    return value


class Ranks:
    """Ranks of growing numbers, by the robot whose they are and by their sort."""

    def __init__(self) -> None:
        self._values: dict[tuple[str, str], list[int]] = {}
        self._counts: dict[tuple[str, str], set[int]] = {}

    def note(self, robot: str, number: GrowingNumber) -> None:
        """Take down a number of a robot."""
        self._values.setdefault((robot, number.sort), []).append(number.value)
        if number.counts:
            self._counts.setdefault((robot, number.sort), set()).add(number.value)

    def __iter__(self) -> Iterator[tuple[tuple[str, str], list[int]]]:
        """The ranks of all numbers in the order in which they came.

        A number above the count, such as a damaged one, will be met by the count some day: when, its value
        says; so then all stay as they are. 0 is no number.
        """
        for key, values in self._values.items():
            ranks = {value: rank for rank, value in enumerate(sorted({0, *values}))}
            is_below = self._counts.get(key) == {max(values)}
            yield key, [ranks[each] for each in values] if is_below else values
