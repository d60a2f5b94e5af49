"""Operators' stops of robots, and the commands that were under way at that time."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from typing import Any

from arboleda.drivers import Command, Evidence, Robot, needs_clear
from arboleda.model.messages import Fact, OperatorAnswer, Remember, Verb
from arboleda.model.plant_model import PlantModel
from arboleda.wire.forms import form_of
from arboleda.wire.payloads import Goal, JointsGoal, StopGoal

from .robot import Act

UNDER_WAY_S = 60.0  # a command that was sent longer ago does not arrive any more
KEPT = 16
ROUNDING_DEG = 1e-3  # of angles on the wire


class Stops:
    """Operators' stops, each until clear and reset; what was sent before one may still arrive."""

    def __init__(self, model: PlantModel) -> None:
        self._model = model
        self._cleared: dict[str, bool] = {}  # stopped robot -> it was cleared
        self._resets: set[str] = set()  # robots in the scope of a reset that was answered in this step
        self._forgotten: set[str] = set()
        self._sent: dict[str, deque[tuple[float, Command]]] = {
            name: deque(maxlen=KEPT) for name in model.robots
        }

    def holds(self, robot: str) -> bool:
        """True while an operator's stop of this robot holds."""
        return robot in self._cleared

    def sent(self, command: Command, now: float) -> None:
        """Take in a command of the plant."""
        if not self.holds(command.robot) and needs_clear(command):
            self._sent[command.robot].append((now, command))

    def breaks(self, robot: Robot, act: Act, now: float) -> bool:
        """True if a stop holds that a board's act breaks: nothing sent before it explains the act."""
        under_way = self._sent[robot.name]
        for at, command in under_way:
            if at > now - UNDER_WAY_S and is_order_of(act.goal, robot, command):
                under_way.remove((at, command))
                return False
        return self.holds(robot.name)

    def answered(self, answer: OperatorAnswer) -> None:
        """Take in that an operator's verb was carried out."""
        robots = robots_of(self._model, answer.scope)
        if answer.verb is Verb.STOP:
            self._cleared.update(dict.fromkeys(robots, False))
        elif answer.verb is Verb.CLEAR:
            self._cleared.update({name: True for name in robots if name in self._cleared})
        elif answer.verb is Verb.RESET:
            cells = {cell.name for name in robots for cell in self._model.cells_of[name]}
            self._resets.update(
                robot.name for cell in self._model.cells if cell.name in cells for robot in cell.robots
            )

    def remembered(self, fact: Remember) -> None:
        """Take in a reset by what is kept: a stop that the reset has ended need not be kept any more."""
        if fact.fact is Fact.LATCH and fact.value is None:
            self._forgotten.add(fact.name)

    def restart(self, kept: Mapping[str, str]) -> None:
        """Begin with a plant that starts: stops under way at the old one's death hold if kept."""
        self._cleared = {name: word == "cleared" for name, word in kept.items()}

    def settle(self) -> None:
        """End the stops that were cleared and then reset in this step."""
        if self._resets:
            for name in self._resets & self._forgotten:
                if self._cleared.get(name):
                    del self._cleared[name]
        if self._resets or self._forgotten:
            self._resets, self._forgotten = set(), set()


def robots_of(model: PlantModel, scope: str) -> list[str]:
    """The robots of an operator's scope: the plant, a cell or a robot."""
    scope = scope.strip().lower()
    if scope in ("", "plant"):
        return list(model.robots)
    if scope in model.robots:
        return [scope]
    return [robot.name for cell in model.cells if cell.name == scope for robot in cell.robots]


def is_order_of(goal: Goal, robot: Robot, command: Command) -> bool:
    """True if a goal on the wire is this command: to the same place by another token is another one."""
    stamp: dict[str, Any] = {"seq": goal.seq, "epoch": goal.epoch}
    if not isinstance(goal, StopGoal):
        if robot.evidence is Evidence.IDS and goal.token != command.token:
            return False
        stamp |= {"heard": goal.heard, "token": goal.token}
    _, expected = form_of(robot).goal(robot, command, **stamp)
    if isinstance(goal, JointsGoal) and isinstance(expected, JointsGoal):
        return all(abs(a - b) < ROUNDING_DEG for a, b in zip(goal.q_deg, expected.q_deg, strict=True))
    return goal == expected
