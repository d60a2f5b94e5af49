"""A machine that is always in the way of one zone or another: every state of it and two arms is tried."""

from __future__ import annotations

import pickle
from itertools import combinations, product

import pytest

from arboleda.dispatch.zones import Zones
from arboleda.model.errors import IllegalTransition

NAMES, ARMS, LIFT = ("low", "high", "aisle"), ("ra1", "ra2"), "lift"
LANDINGS = frozenset({"low", "high"})
WISHES = [frozenset(some) for size in (1, 2, 3) for some in combinations(NAMES, size)]
Key = tuple[object, ...]


def read(zones: Zones) -> Key:
    return tuple(zones.holder(name) for name in NAMES), zones.queue.waiting


def arrive(zones: Zones, at: str) -> tuple[str, ...]:
    """The machine has moved over: it is out of the other landing."""
    return zones.give_back(LANDINGS - {at}) if zones.held_by(LIFT) == LANDINGS else ()


def explored() -> dict[Key, bytes]:
    start = Zones(NAMES)
    start.claim(LIFT, frozenset({"low"}))
    found = {read(start): pickle.dumps(start)}
    frontier = list(found)
    while frontier:
        frozen = found[frontier.pop()]
        acts = [
            *(lambda zones, a=arm, w=wish: zones.acquire(a, w) for arm, wish in product(ARMS, WISHES)),
            *(lambda zones, a=arm: zones.release(a) for arm in ARMS),
            *(lambda zones, r=robot: zones.withdraw(r) for robot in (*ARMS, LIFT)),
            *(
                lambda zones, at=at: zones.acquire(LIFT, frozenset({at}), moves_over=True)
                for at in sorted(LANDINGS)
            ),
            *(lambda zones, at=at: arrive(zones, at) for at in sorted(LANDINGS)),
        ]
        for act in acts:
            zones = pickle.loads(frozen)
            try:
                act(zones)
            except IllegalTransition:
                continue
            if read(zones) not in found:
                found[read(zones)] = pickle.dumps(zones)
                frontier.append(read(zones))
    return found


@pytest.fixture(scope="module")
def states() -> dict[Key, bytes]:
    return explored()


def test_it_is_never_without_a_landing_and_nobody_is_in_one_with_it(states: dict[Key, bytes]) -> None:
    assert len(states) > 200
    for frozen in states.values():
        assert pickle.loads(frozen).held_by(LIFT) & LANDINGS


def test_it_waits_before_whoever_may_wait_for_what_it_leaves(states: dict[Key, bytes]) -> None:
    seen = 0
    for frozen in states.values():
        waiting = [robot for robot, _ in pickle.loads(frozen).queue.waiting]
        seen += LIFT in waiting
        assert LIFT not in waiting[1:]
    assert seen


def test_whoever_waits_is_served_once_the_others_leave_and_it_moves(states: dict[Key, bytes]) -> None:
    for frozen in states.values():
        zones = pickle.loads(frozen)
        for _ in range(4):
            for arm in ARMS:
                zones.release(arm)
            zones.withdraw(LIFT)
            goal = min(LANDINGS - zones.held_by(LIFT) or LANDINGS)
            zones.acquire(LIFT, frozenset({goal}), moves_over=True)
            arrive(zones, goal)
        wishes = [wish for robot, wish in zones.queue.waiting if robot != LIFT]
        assert not wishes or wishes[0] >= LANDINGS  # both at once nobody gets while it is in one
