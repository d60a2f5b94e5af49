"""Who is sent what: nothing while nobody looks, one frame for all that look, nothing twice."""

from __future__ import annotations

import asyncio
import json
from typing import Any

import pytest

from arboleda.dashboard.twin.show import BEHIND, Show


class Screen:
    connected = True

    def __init__(self) -> None:
        self.frames: list[tuple[int, dict[str, Any]]] = []

    def draw(self, number: int, patch: str) -> None:
        self.frames.append((number, json.loads(patch)))


class Plant:
    """Counts how often it was asked; `value` is all there is to draw."""

    value = 1
    asked = 0

    def positions(self) -> dict[str, Any]:
        self.asked += 1
        return {"now": 0.0}


class Drawing:
    def __init__(self, plant: Plant) -> None:
        self._plant = plant

    def frame(self, positions: dict[str, Any], now: float) -> dict[str, Any]:
        return {"robot/a": self._plant.value, "robot/b": 0}


@pytest.fixture
def plant() -> Plant:
    return Plant()


@pytest.fixture
def show(plant: Plant) -> Show:
    made = Show(plant)  # type: ignore[arg-type]
    made.open(Drawing(plant))  # type: ignore[arg-type]
    return made


def test_nobody_looks_and_nothing_is_asked(show: Show, plant: Plant) -> None:
    async def a_while() -> None:
        running = asyncio.create_task(show.run())
        await asyncio.sleep(0)
        running.cancel()

    show.turn()
    asyncio.run(a_while())
    assert plant.asked == 0


def test_who_begins_to_look_is_told_everything_then_what_changed(show: Show, plant: Plant) -> None:
    screen = Screen()
    show.look(screen)
    show.turn()
    plant.value = 2
    show.turn()
    show.turn()
    assert screen.frames == [(1, {"robot/a": 1, "robot/b": 0}), (2, {"robot/a": 2})]


def test_all_who_look_are_told_from_one_look_at_the_plant(show: Show, plant: Plant) -> None:
    screens = [Screen() for _ in range(5)]
    for screen in screens:
        show.look(screen)
    show.turn()
    assert plant.asked == 1 and all(len(screen.frames) == 1 for screen in screens)


def test_who_leaves_is_told_no_more(show: Show, plant: Plant) -> None:
    screen = Screen()
    show.look(screen)
    show.turn()
    show.leave(screen)
    plant.value = 2
    show.turn()
    assert len(screen.frames) == 1 and plant.asked == 1


def test_who_was_away_is_told_everything_when_back(show: Show, plant: Plant) -> None:
    screen = Screen()
    show.look(screen)
    show.turn()
    screen.connected = False
    plant.value = 2
    show.turn()
    screen.connected = True
    show.turn()
    assert screen.frames[1][1] == {"robot/a": 2, "robot/b": 0}


def test_who_does_not_draw_gets_no_more_until_it_has(show: Show, plant: Plant) -> None:
    screen = Screen()
    show.look(screen)
    for value in range(3 * BEHIND):
        plant.value = value
        show.turn()
    sent = len(screen.frames)
    assert sent <= BEHIND + 2
    show.drawn(screen, screen.frames[-1][0])
    show.turn()
    assert len(screen.frames) == sent + 1 and screen.frames[-1][1] == {"robot/a": plant.value, "robot/b": 0}


def test_a_plant_at_rest_leaves_nobody_behind(show: Show, plant: Plant) -> None:
    screen = Screen()
    show.look(screen)
    for _ in range(3 * BEHIND):
        show.turn()
    for value in (2, 3):
        plant.value = value
        show.turn()
    assert [number for number, _ in screen.frames] == [1, 2, 3]


def test_one_who_comes_late_is_not_taken_for_one_who_is_behind(show: Show, plant: Plant) -> None:
    first, late = Screen(), Screen()
    show.look(first)
    for value in range(BEHIND * 2):
        plant.value = value
        show.turn()
        show.drawn(first, first.frames[-1][0])
    show.look(late)
    for value in (1000, 1001):
        plant.value = value
        show.turn()
    assert len(late.frames) == 2
