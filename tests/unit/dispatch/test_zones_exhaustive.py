"""Two arms, a machine, four zones: every act from every reachable state keeps the rules of shared zones."""

from __future__ import annotations

import pickle
from functools import cache
from itertools import combinations, permutations, product
from typing import Any, NamedTuple

import pytest

from arboleda.dispatch.zones import Zones
from arboleda.model.errors import IllegalTransition

pytestmark = pytest.mark.long

NAMES, ARMS, MILL = ("w", "x", "y", "z"), ("ra1", "ra2"), "mill"
ROBOTS = (*ARMS, MILL)
WISHES = [frozenset(some) for size in (1, 2, 3, 4) for some in combinations(NAMES, size)]
DOOR = frozenset({"w"})  # the zone that the mill shuts off, when it is told to or by somebody's hand
ACTS: list[tuple[str, tuple[Any, ...]]] = [
    *(("acquire", (arm, wish)) for arm, wish in product(ARMS, WISHES)),
    ("acquire", (MILL, DOOR)),
    ("claim", (MILL, DOOR)),
    *((verb, (robot,)) for verb in ("withdraw", "release", "quarantine", "restore") for robot in ROBOTS),
    *(("override", (zone,)) for zone in NAMES),
]


class State(NamedTuple):
    """All that can be read of Zones."""

    occupied: frozenset[tuple[str, str]]  # (zone, robot)
    quarantined: frozenset[str]
    waiting: tuple[tuple[str, frozenset[str]], ...]

    def held_by(self, robot: str) -> frozenset[str]:
        return frozenset(zone for zone, holder in self.occupied if holder == robot)


class Step(NamedTuple):
    """One act; `granted` are the robots it gave their zones, None where it was refused."""

    before: State
    verb: str
    arguments: tuple[Any, ...]
    after: State
    granted: tuple[str, ...] | None


class Explored(NamedTuple):
    """Each reachable state with the pickled Zones in it, and each act from each of them."""

    states: dict[State, bytes]
    steps: list[Step]


@cache
def explored() -> Explored:
    start = Zones(NAMES)
    found = Explored({read(start): pickle.dumps(start)}, [])
    frontier = list(found.states)
    while frontier:
        before = frontier.pop()
        for verb, arguments in ACTS:
            zones = pickle.loads(found.states[before])
            granted = act(zones, verb, arguments)
            after = read(zones)
            found.steps.append(Step(before, verb, arguments, after, granted))
            if after not in found.states:
                found.states[after] = pickle.dumps(zones)
                frontier.append(after)
    return found


def read(zones: Zones) -> State:
    occupied = frozenset((name, robot) for name in NAMES if (robot := zones.holder(name)))
    return State(occupied, frozenset(filter(zones.is_quarantined, NAMES)), zones.queue.waiting)


def act(zones: Zones, verb: str, arguments: tuple[Any, ...]) -> tuple[str, ...] | None:
    """The robots that got their zones by this act, None where it was refused."""
    inside = bool(zones.held_by(arguments[0]))
    try:
        answer = getattr(zones, verb)(*arguments)
    except IllegalTransition:
        return None
    if verb in ("acquire", "claim"):
        return (arguments[0],) if (answer or verb == "claim") and not inside else ()
    return answer or ()


def test_all_states_are_explored() -> None:
    assert (len(explored().states), len(explored().steps)) == (3435, 3435 * len(ACTS))


def test_a_refused_act_changes_nothing() -> None:
    assert all(step.after == step.before for step in explored().steps if step.granted is None)


def test_a_zone_changes_hands_only_by_an_act_that_frees_it() -> None:
    for before, verb, arguments, after, _ in explored().steps:
        for zone, holder in before.occupied - after.occupied:
            ends = [("restore", holder), ("override", zone)]
            assert (verb, arguments[0]) in (ends if zone in before.quarantined else [("release", holder)])


def test_quarantine_begins_with_its_holder_and_ends_by_restore_or_override() -> None:
    for before, verb, arguments, after, _ in explored().steps:
        holders = dict(before.occupied)
        for zone in after.quarantined - before.quarantined:
            assert (verb, arguments[0]) == ("quarantine", holders[zone])
        for zone in before.quarantined - after.quarantined:
            assert (verb, arguments[0]) in [("restore", holders[zone]), ("override", zone)]


def test_who_is_granted_gets_all_it_asked_for_and_nobody_else_gets_anything() -> None:
    for before, _, arguments, after, granted in explored().steps:
        asked = dict(before.waiting) | ({arguments[0]: arguments[1]} if len(arguments) == 2 else {})
        for robot in ROBOTS:
            gained = after.held_by(robot) - before.held_by(robot)
            assert gained == (asked[robot] if robot in (granted or ()) else frozenset())


def test_grants_keep_the_order_of_asking() -> None:
    for before, verb, _, after, granted in explored().steps:
        order = [robot for robot, _ in before.waiting]
        assert [robot for robot in order if robot in (granted or ())] == [
            robot for robot in granted or () if robot in order
        ]
        stayed = [robot for robot in order if robot in dict(after.waiting)]
        assert [robot for robot, _ in after.waiting][: len(stayed)] == stayed
        for (first, wish), later in product(after.waiting, () if verb == "claim" else granted or ()):
            earlier = first in order and (later not in order or order.index(first) < order.index(later))
            assert not (earlier and wish & after.held_by(later))


def test_a_request_waits_until_it_is_granted_or_withdrawn() -> None:
    for before, verb, arguments, after, granted in explored().steps:
        for robot, wish in before.waiting:
            gone = robot in (granted or ()) or (verb, arguments) == ("withdraw", (robot,))
            assert gone or dict(after.waiting)[robot] == wish


def test_nobody_waits_without_a_cause_and_nobody_waits_inside() -> None:
    for state in explored().states:
        taken = {zone for zone, _ in state.occupied}
        for robot, wish in state.waiting:
            assert wish & taken and not state.held_by(robot)
            taken |= wish


@pytest.mark.parametrize("order", list(permutations(ROBOTS)), ids="-".join)
def test_whoever_waits_is_served_when_the_others_leave_in_any_order(order: tuple[str, ...]) -> None:
    for state, frozen in explored().states.items():
        zones, served = pickle.loads(frozen), set[str]()
        for robot in order * len(ROBOTS):
            served |= {*zones.restore(robot), *zones.release(robot)}
        assert served == set(dict(state.waiting))
        assert read(zones) == State(frozenset(), frozenset(), ())
