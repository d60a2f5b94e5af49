"""The demonstration: tasks that never end, and now and then a fault that somebody can learn from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from arboleda.drivers import MotionState, Robot
from arboleda.model.plant_model import Cell, Link, PlantModel
from arboleda.sim.devices import Alarm, Reboot
from arboleda.views.view import standing
from arboleda_proofs.simulator.chance import Dice
from arboleda_proofs.simulator.people import text_of

REST_S = 3.0  # a cell rests so long between two tasks: an idle one is to be seen, too
CALM_S = 30.0  # all cells were well for so long before one fails
ALARM_S = 3.0
WELL = ("idle", "execute")
Snapshot = dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class Task:
    """A task that the demonstration gives."""

    text: str


@dataclass(frozen=True, kw_only=True)
class DemoEnded:
    """Somebody ends the demonstration; the plant stays up."""


class Demo:
    """Demonstration: gives each cell that rests a task, and has a device of one cell after the other fail.

    An arm loses its power: its cell is held, and somebody has to press what leads out of that. The driver of
    any other board reports an alarm for a while: the task fails, and the cell goes on by itself. Nothing
    fails while a cell needs somebody, nor while a device holds a part. Pure: time is handed to it.
    """

    def __init__(self, model: PlantModel, seed: int = 0) -> None:
        self.is_on = True
        self._cells = {cell.name: cell for cell in model.cells if cell.recipes}
        self._dice = Dice(seed, "demonstration")
        self._rested: dict[str, float] = {}  # by cell that rests: when it gets a task
        self._repairs: dict[str, float] = {}  # by board whose driver reports an alarm: when that is over
        self._fails_at = math.inf
        self._faults = 0

    @property
    def next_deadline(self) -> float | None:
        return min((*self._repairs.values(), *(self._rested.values() if self.is_on else ())), default=None)

    def step(self, now: float, events: Sequence[Snapshot | DemoEnded]) -> list[Task | Reboot | Alarm]:
        """The tasks and faults that are due after a look at the news of the plant."""
        out: list[Task | Reboot | Alarm] = []
        for event in events:
            if isinstance(event, DemoEnded):
                self.is_on = False
            elif self.is_on:
                self._rest(now, event)
                out += self._fault(now, event)
        return [*out, *self._repaired(now), *(self._tasks(now) if self.is_on else ())]

    def _rest(self, now: float, snapshot: Snapshot) -> None:
        resting = [cell["name"] for cell in snapshot["cells"] if _rests(cell)]
        due = {name: self._rested.get(name, now + REST_S) for name in resting if name in self._cells}
        self._rested = due

    def _tasks(self, now: float) -> list[Task]:
        due = [name for name, at in self._rested.items() if at <= now]
        for name in due:
            del self._rested[name]
        return [Task(text=text_of(self._cells[name], self._dice)) for name in due]

    def _fault(self, now: float, snapshot: Snapshot) -> list[Reboot | Alarm]:
        if self._repairs or any(standing(cell) not in WELL for cell in snapshot["cells"]):
            self._fails_at = math.inf
            return []
        self._fails_at = min(self._fails_at, now + CALM_S)
        robot = self._next() if now >= self._fails_at else None
        if robot is None or not _moves_empty(snapshot, robot):
            return []
        self._faults += 1
        self._fails_at = math.inf
        if robot.joints:
            return [Reboot(at=now, board=robot.mqtt)]
        self._repairs[robot.mqtt] = now + ALARM_S
        return [Alarm(at=now, board=robot.mqtt, is_on=True)]

    def _next(self) -> Robot | None:
        """The device that fails next: cells take turns, in each of them self-healing devices come first."""
        cells = [cell for cell in self._cells.values() if _boards(cell)]
        if not cells:
            return None
        boards = _boards(cells[self._faults % len(cells)])
        return boards[self._faults % len(boards)]

    def _repaired(self, now: float) -> list[Alarm]:
        over = [board for board, at in self._repairs.items() if at <= now]
        for board in over:
            del self._repairs[board]
        return [Alarm(at=now, board=board, is_on=False) for board in over]


def _boards(cell: Cell) -> list[Robot]:
    """The devices of a cell that have a virtual board and move, arms last."""
    boards = [robot for robot in cell.robots if robot.link is Link.MQTT and robot.position_key]
    return sorted(boards, key=lambda robot: bool(robot.joints))


def _rests(cell: dict[str, Any]) -> bool:
    return standing(cell) == "idle" and not cell["task"] and not cell["queue"] and not cell["paused"]


def _moves_empty(snapshot: Snapshot, robot: Robot) -> bool:
    row = next((row for row in snapshot["robots"] if row["name"] == robot.name), None)
    return row is not None and row["state"] == MotionState.MOVING.value and not row["holding"]
