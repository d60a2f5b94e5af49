"""Cells that take shared devices before any zone never wait in a ring: every state is tried."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

import pytest

from arboleda.dispatch.zones import Zones
from arboleda.model.errors import IllegalTransition

DEVICES, ZONES = ("lift", "belt"), ("door", "shaft")
NEEDS = {  # of each cell: devices for the whole task, then what its robot takes, one way after the other
    "a": (frozenset({"lift", "belt"}), (frozenset({"door", "shaft"}), frozenset({"shaft"}))),
    "b": (frozenset({"lift"}), (frozenset({"shaft"}), frozenset({"door"}))),
    "c": (frozenset({"belt"}), (frozenset({"door"}),)),
}
Step = tuple[int, ...]  # how far each cell is
Key = tuple[Step, tuple[object, ...]]


def phases(cell: str) -> int:
    """Ask for devices; for each way ask for zones and leave them; give the devices back."""
    return 2 + 2 * len(NEEDS[cell][1])


class Floor:
    """The zones after a history of acts of the cells."""

    def __init__(self, history: tuple[str, ...]) -> None:
        self.zones = Zones((*ZONES, *DEVICES))
        self.at = dict.fromkeys(NEEDS, 0)
        for cell in history:
            self.go(cell)

    def go(self, cell: str) -> bool:
        """Let a cell do what it does next; whether it got further."""
        devices, ways = NEEDS[cell]
        at, robot = self.at[cell], f"{cell}_arm"
        if at == 0:
            on = devices <= self.zones.held_by(cell) or self.zones.request(cell, devices)
        elif at == phases(cell) - 1:
            self.zones.give_back(devices)
            on = True
        elif at % 2:
            asked = ways[at // 2]
            on = asked <= self.zones.held_by(robot) or self.zones.request(robot, asked)
        else:
            self.zones.release(robot)
            on = True
        self.at[cell] += on
        return on

    @property
    def key(self) -> Key:
        holders = tuple(self.zones.holder(each) for each in (*ZONES, *DEVICES))
        return tuple(self.at.values()), (holders, self.zones.waiting)


def states() -> Iterator[tuple[str, ...]]:
    """A history that leads to each state that can be reached."""
    seen: set[Key] = {Floor(()).key}
    frontier: deque[tuple[str, ...]] = deque([()])
    while frontier:
        history = frontier.popleft()
        yield history
        for cell in NEEDS:
            if Floor(history).at[cell] < phases(cell):
                after = Floor((*history, cell))
                if after.key not in seen:
                    seen.add(after.key)
                    frontier.append((*history, cell))


@pytest.fixture(scope="module")
def histories() -> list[tuple[str, ...]]:
    return list(states())


def test_in_every_state_somebody_can_go_on(histories: list[tuple[str, ...]]) -> None:
    assert len(histories) > 100
    for history in histories:
        left = [cell for cell, at in Floor(history).at.items() if at < phases(cell)]
        assert not left or any(Floor(history).go(cell) for cell in left), history


def test_from_every_state_all_come_to_their_end(histories: list[tuple[str, ...]]) -> None:
    for history in histories:
        floor = Floor(history)
        for _ in range(sum(map(phases, NEEDS))):
            for cell in NEEDS:
                if floor.at[cell] < phases(cell):
                    floor.go(cell)
        assert [floor.at[cell] for cell in NEEDS] == [phases(cell) for cell in NEEDS], history
        assert floor.zones.robots == set()


def test_a_cell_that_holds_one_device_cannot_ask_for_more() -> None:
    zones = Zones(DEVICES)
    assert zones.request("a", frozenset({"lift"}))
    with pytest.raises(IllegalTransition, match="nobody standing in a zone waits for another"):
        zones.request("a", frozenset({"lift", "belt"}))
