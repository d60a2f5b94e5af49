"""Rules of the bridge, written down once more without its short cuts, and checked board by board.

The bridge's own memory is not read. `Bridges.wrong` has the sentences on each breach, by the rule's name.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping
from typing import Any

from arboleda.drivers import Command, Report
from arboleda.engine import Belief
from arboleda.model.messages import Heartbeat
from arboleda.model.plant_model import Link, PlantModel
from arboleda.rig.moment import BridgeStep
from arboleda.wire import rejections
from arboleda.wire.hop import FromPlant
from arboleda.wire.rejections import ForeignCommand, Rejection
from arboleda.wire.transport import Connection, Delivery, Publication

from .bridged_board import BridgedBoard

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
        self._bridge, self._known = bridge, _Bridge(self._model, self.wrong)
        self._known.take_over(now, beliefs)

    def look(self, passed: Iterable[BridgeStep]) -> None:
        self.wrong.clear()
        self.of_others.clear()
        for each in passed:
            if each.bridge is not self._bridge:
                self._bridge, self._known = each.bridge, _Bridge(self._model, self.wrong)
            if self._known is not None:
                self._known.take(each)
                self.of_others += self._known.of_others


class _Bridge:
    """One start of the bridge."""

    def __init__(self, model: PlantModel, wrong: defaultdict[str, list[str]]) -> None:
        reached = [robot for robot in model.robots.values() if robot.link is Link.MQTT]
        robots = [robot for robot in reached if robot.goes]
        self._wrong = wrong
        self._boards = {
            robot.name: BridgedBoard(robot, model.timing.stale_after_s, wrong) for robot in robots
        }
        self._rows = [(name, board.robot.mqtt, board) for name, board in self._boards.items()]
        self._by_topic = {
            f"{robot.mqtt}/{channel}": (robot.name, self._boards[robot.name], channel)
            for robot in robots
            for channel in ("sensores", "conexion")
        }
        self._plant: int | None = None  # whose heartbeat it hears
        self._patience_s = model.timing.stale_after_s
        self._beat_at = -math.inf
        self.of_others: list[Command] = []

    def take_over(self, now: float, beliefs: Mapping[str, Belief]) -> None:
        self._beat_at = now
        for name, board in self._boards.items():
            board.take_over(now, beliefs[name])
            self._plant = beliefs[name].plant

    def take(self, passed: BridgeStep) -> None:
        reports: defaultdict[str, list[Report]] = defaultdict(list)
        published: defaultdict[str, list[Publication]] = defaultdict(list)
        for message in passed.out:
            if isinstance(message, Report):
                reports[message.robot].append(message)
            elif isinstance(message, Publication):
                published[message.topic.partition("/")[0]].append(message)
            elif isinstance(message, Rejection | ForeignCommand):
                self._answer(message, self._boards.get(message.robot))
        self.of_others.clear()
        late = False
        now = passed.now
        for event in passed.events:
            late = late or event.at < now
            if not isinstance(event, Delivery):
                self._event(event, now)
            elif event.topic in self._by_topic:
                name, board, channel = self._by_topic[event.topic]
                if board.repeats and board.hear_again(event, now, reports[name]):
                    del reports[name]
                else:
                    board.deliver(event, channel)
        for name, mqtt, board in self._rows:
            if board.touched or name in reports or mqtt in published or board.link.silent_at <= now:
                board.end_step(now, reports[name], published[mqtt], late=late)

    def _answer(self, message: Rejection | ForeignCommand, board: BridgedBoard | None) -> None:
        if board is not None and isinstance(message, Rejection):
            board.reject(message)
        elif board is not None:
            board.obey_foreign(taken=message.sentence.key == rejections.TAKEN.key)

    def _event(self, event: Any, now: float) -> None:
        if isinstance(event, Connection):
            for board in self._boards.values():
                board.connect(event.up)
        elif isinstance(event, FromPlant):
            message = event.message
            if isinstance(message, Heartbeat):
                self._beat(event.at, message.epoch, event.unix_s)
            else:
                self._command(event, message, now, self._boards.get(message.robot))

    def _command(self, event: FromPlant, command: Command, now: float, board: BridgedBoard | None) -> None:
        if not command.id:
            is_alone = event.at >= self._beat_at + PLANT_GONE_S and now - event.at <= self._patience_s
            self.of_others += [command] if is_alone else []
            if board is not None:
                board.hear_others(event.at, command, event.sender, is_alone=is_alone)
        elif board is not None:
            if event.copied:
                board.expect_copy(event.at, command)
            board.command(command, self._plant)

    def _beat(self, at: float, epoch: int, unix_s: int | None) -> None:
        if epoch > (YEAR_2100 if unix_s is None else unix_s + AHEAD_S):
            return
        if self._plant is None or epoch >= self._plant:
            self._plant, self._beat_at = epoch, at
            for board in self._boards.values():
                board.hear_plant(epoch)
