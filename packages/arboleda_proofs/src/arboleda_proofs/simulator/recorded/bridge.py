"""Input and output of each bridge, board by board and step by step, for the three properties of it.

`Bridges.wrong` has the sentences on each breach, by the rule's name.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping
from typing import Any

from arboleda.drivers import Command, MotionState, Report, Robot
from arboleda.engine import Belief
from arboleda.model.plant_model import Link, PlantModel
from arboleda.rig.moment import BridgeStep
from arboleda.wire.hop import FromPlant
from arboleda.wire.transport import Connection, Delivery, Publication

from .board_step import BoardStep
from .motions import BEATS, Motions
from .passed_commands import COMMANDS, PassedCommands
from .reported_telemetry import REPORTS, ReportedTelemetry

YEAR_2100, AHEAD_S = 4_102_444_800, 366 * 86_400  # Unix time; how far ahead another machine's clock may be
PLANT_GONE_S = 5.0  # after its last heartbeat the bridge obeys whoever commands


class Bridges:
    """Follows every bridge of the plant.

    Of the last pass in which a bridge did something: `wrong` are the breaches, rule -> sentences; `of_others`
    are the commands without an id that it took in, and so obeys, while it heard no plant.
    """

    def __init__(self, model: PlantModel) -> None:
        self.wrong: defaultdict[str, list[str]] = defaultdict(list)
        self.of_others: list[Command] = []
        self._model = model
        self._bridge: Any = None
        self._known: _Bridge | None = None

    def take_over(self, bridge: Any, now: float, beliefs: Mapping[str, Belief]) -> None:
        """Take over the plant's beliefs, this once: of a bridge that ran before this record began."""
        self._bridge, self._known = bridge, _Bridge(self._model, self)
        self._known.take_over(now, beliefs)

    def look(self, passed: Iterable[BridgeStep]) -> None:
        self.wrong.clear()
        self.of_others.clear()
        for each in passed:
            if each.bridge is not self._bridge:
                self._bridge, self._known = each.bridge, _Bridge(self._model, self)
            if self._known is not None:
                self._known.take(each)


class _Board:
    """One board: the three properties, and its part of the step under way; `up`: it is there, as is said."""

    def __init__(self, robot: Robot, patience_s: float) -> None:
        self.up = self.touched = False
        self.step = BoardStep()
        self.reports, self.motions = ReportedTelemetry(robot, patience_s), Motions(robot)
        self.rules = (REPORTS, self.reports), (COMMANDS, PassedCommands(robot)), (BEATS, self.motions)


class _Bridge:
    """One start of the bridge."""

    def __init__(self, model: PlantModel, found: Bridges) -> None:
        robots = [each for each in model.robots.values() if each.link is Link.MQTT and each.goes]
        self._found = found
        self._patience_s = model.timing.stale_after_s
        self._boards = {robot.name: _Board(robot, self._patience_s) for robot in robots}
        self._by_topic = {robot.mqtt: self._boards[robot.name] for robot in robots}
        self._plant: int | None = None  # whose heartbeat it hears
        self._beat_at = -math.inf

    def take_over(self, now: float, beliefs: Mapping[str, Belief]) -> None:
        self._beat_at = now
        for name, board in self._boards.items():
            board.up, self._plant = beliefs[name].heard_at is not None, beliefs[name].plant
            board.step.is_up = board.up
            board.reports.take_over(now, beliefs[name])

    def take(self, passed: BridgeStep) -> None:
        now, late, is_beaten, plants = passed.now, False, False, [self._plant]
        for event in passed.events:
            late = late or event.at < now
            if isinstance(event, Delivery):
                mqtt, _, channel = event.topic.partition("/")
                board = self._by_topic.get(mqtt)
                if board is not None and channel == "sensores":
                    board.touched = True
                    board.step.heard.append(event)
                elif board is not None and channel == "conexion":
                    board.touched = True
                    board.step.stir(gone=event.payload == b"0")
            elif isinstance(event, Connection):
                for board in self._boards.values():
                    board.touched = True
                    board.step.stir(gone=not event.up)
            elif not isinstance(event, FromPlant):
                continue
            elif isinstance(event.message, Command):
                self._command(event.at, event.message, now)
            elif self._beat(event.at, event.message.epoch, event.unix_s):
                is_beaten = True
                plants += [self._plant] if self._plant != plants[-1] else []
        for message in passed.out:
            if isinstance(message, Publication):
                board = self._by_topic.get(message.topic.partition("/")[0])
            else:
                board = self._boards.get(message.robot)
            if board is None:
                continue
            board.touched, step = True, board.step
            if isinstance(message, Publication):
                step.published.append(message)
            elif not isinstance(message, Report):
                step.notices.append(message)
            else:
                step.reports.append(message)
                if message.state is MotionState.NO_LINK:
                    step.is_up, step.is_lost = False, True
                elif message.state is not None:
                    step.is_up = True
                    step.states.append(message)
        wrong = self._found.wrong
        for board in self._boards.values():
            is_silent = board.up and board.reports.silent_at <= now
            if board.touched or is_silent or (is_beaten and board.motions.lasts):
                step = board.step
                step.now, step.late, step.was_up, step.plants = now, late, board.up, plants
                step.is_beaten, board.up, board.touched = is_beaten, step.is_up, False
                if board.motions.may_last or not board.reports.is_told_again(step):
                    for rule, judge in board.rules:
                        for sentence in judge.breaches(step):
                            wrong[rule].append(sentence)
                step.is_lost = step.is_stirred = step.is_shut = False
                for each in step.lists:
                    each.clear()

    def _command(self, at: float, command: Command, now: float) -> None:
        board = self._boards.get(command.robot)
        if board is not None:
            board.touched = True
            board.step.command(at, command, self._plant)
        is_alone = at >= self._beat_at + PLANT_GONE_S and now - at <= self._patience_s
        if not command.id and is_alone:
            self._found.of_others.append(command)

    def _beat(self, at: float, epoch: int, unix_s: int | None) -> bool:
        """Take in a heartbeat; False if it is none of a plant that the bridge may hear."""
        if epoch > (YEAR_2100 if unix_s is None else unix_s + AHEAD_S) or epoch < (self._plant or 0):
            return False
        self._plant, self._beat_at = epoch, at
        return True
