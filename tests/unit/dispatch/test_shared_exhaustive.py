"""Cells that take shared devices before any zone never wait in a ring: every state is tried."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

import pytest

from arboleda.dispatch.zones import Zones
from arboleda.model.errors import IllegalTransition

pytestmark = pytest.mark.long

DEVICES, ZONES = ("lift", "belt"), ("door", "shaft")
Act = tuple[str, frozenset[str]]
Step = tuple[int, ...]  # how far each cell is
Key = tuple[Step, tuple[object, ...]]


def uses(*names: str) -> tuple[Act, ...]:
    return (("take devices", frozenset(names)),)


def goes(*names: str) -> tuple[Act, ...]:
    """A visit: its robot takes the zones of a way at once, and leaves them."""
    return (("take zones", frozenset(names)), ("leave zones", frozenset()))


def gives(*names: str) -> tuple[Act, ...]:
    return (("leave devices", frozenset(names)),)


ACTS = {  # of each cell; what two branches of a parallel do is in two rows
    "a": (*uses("lift", "belt"), *goes("door", "shaft"), *gives("lift", "belt")),
    "b": (*uses("lift"), *goes("shaft"), *gives("lift")),
    "c": (*goes("door"), *uses("belt"), *goes("door"), *gives("belt")),  # it tells a device nothing before
    "d": (*uses("lift"), *gives("lift"), *uses("belt"), *gives("belt")),  # one after the other
    "d at the same time": goes("shaft"),
}


class Floor:
    """The zones after a history of acts of the cells."""

    def __init__(self, history: tuple[str, ...]) -> None:
        self.zones = Zones((*ZONES, *DEVICES))
        self.at = dict.fromkeys(ACTS, 0)
        for cell in history:
            self.go(cell)

    def go(self, cell: str) -> bool:
        """Let a cell do what it does next; whether it got further."""
        act, names = ACTS[cell][self.at[cell]]
        robot, on = f"{cell}_arm", True
        if act == "leave devices":
            self.zones.give_back(names)
        elif act == "leave zones":
            self.zones.release(robot)
        else:
            user = cell if act == "take devices" else robot
            on = names <= self.zones.held_by(user) or self.zones.acquire(user, names)
        self.at[cell] += on
        return on

    def ended(self, cell: str) -> bool:
        return self.at[cell] == len(ACTS[cell])

    @property
    def key(self) -> Key:
        holders = tuple(self.zones.holder(each) for each in (*ZONES, *DEVICES))
        return tuple(self.at.values()), (holders, self.zones.queue.waiting)


def states() -> Iterator[tuple[str, ...]]:
    """A history that leads to each state that can be reached."""
    seen: set[Key] = {Floor(()).key}
    frontier: deque[tuple[str, ...]] = deque([()])
    while frontier:
        history = frontier.popleft()
        yield history
        here = Floor(history)
        for cell in ACTS:
            if not here.ended(cell):
                after = Floor((*history, cell))
                if after.key not in seen:
                    seen.add(after.key)
                    frontier.append((*history, cell))


@pytest.fixture(scope="module")
def histories() -> list[tuple[str, ...]]:
    return list(states())


def test_in_every_state_somebody_can_go_on(histories: list[tuple[str, ...]]) -> None:
    assert len(histories) > 1000
    for history in histories:
        here = Floor(history)
        left = [cell for cell in ACTS if not here.ended(cell)]
        assert not left or any(Floor(history).go(cell) for cell in left), history


def test_from_every_state_all_come_to_their_end(histories: list[tuple[str, ...]]) -> None:
    for history in histories:
        floor = Floor(history)
        for _ in range(sum(map(len, ACTS.values()))):
            for cell in ACTS:
                if not floor.ended(cell):
                    floor.go(cell)
        assert all(map(floor.ended, ACTS)), history
        assert floor.zones.robots == set()


def test_a_cell_that_holds_one_device_cannot_ask_for_more() -> None:
    zones = Zones(DEVICES)
    assert zones.acquire("a", frozenset({"lift"}))
    with pytest.raises(IllegalTransition, match="nobody standing in a zone waits for another"):
        zones.acquire("a", frozenset({"lift", "belt"}))
