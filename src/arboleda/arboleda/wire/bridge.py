"""The bridge: commands of the plant to MQTT, telemetry of the boards to reports.

A pure machine; one `Board` per robot does the work, this file routes and keeps what all share:
the plant's epoch and the heartbeat.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

from arboleda.core.errors import PayloadError
from arboleda.core.messages import Command, Heartbeat, Report, Stop, StopMode
from arboleda.core.model import Link, PlantModel

from . import topics
from .board import Board, Counters, Message
from .topics import Channel
from .transport import Connection, Delivery

BEAT_S = 0.25
_ID = re.compile(r"(\d{1,10})-\d{1,10}", re.ASCII)


@dataclass(frozen=True, kw_only=True)
class FromPlant:
    """What the plant's side says to the bridge."""

    at: float
    message: Command | Heartbeat


@dataclass(frozen=True, kw_only=True)
class Leaving:
    """The bridge is about to end; nobody will hear what its boards report."""

    at: float


Event = FromPlant | Delivery | Connection | Leaving


class Bridge:
    """`epoch` is Unix seconds at this start; a board that has heard a higher one raises its own.

    `subscriptions` are the topics to subscribe to, of every robot that speaks MQTT.
    """

    def __init__(self, model: PlantModel, *, epoch: int, now: float) -> None:
        stale_after_s = model.timing.stale_after_s
        robots = [robot for robot in model.robots.values() if robot.link is Link.MQTT]
        self._boards = {
            robot.name: Board(robot, epoch=epoch, stale_after_s=stale_after_s) for robot in robots
        }
        self._stale_at = dict.fromkeys(self._boards, math.inf)  # when silence will have lasted too long
        self._routes = {
            topics.topic(board.robot.mqtt, channel): (name, board, channel)
            for name, board in self._boards.items()
            for channel in Channel
        }
        heard = (Channel.TELEMETRY, Channel.PRESENCE)
        self.subscriptions = tuple(topic for topic, (*_, channel) in self._routes.items() if channel in heard)
        self._epoch = epoch
        self._started_at = now  # never again once that was told
        self._plant_epoch = 0
        self._plant_beats = False
        self._beat_at = math.inf
        self._strays = Counters()
        self.connected = False  # to the broker

    @property
    def counters(self) -> dict[str, Counters]:
        """What was refused or dropped, by robot; "" counts topics that belong to none."""
        return {"": self._strays, **{name: board.counters for name, board in self._boards.items()}}

    @property
    def next_deadline(self) -> float | None:
        """When `step` must be called even without events; None: never."""
        due = min(self._started_at, self._beat_at, *self._stale_at.values())
        return due if due < math.inf else None

    def step(self, now: float, events: Sequence[Event]) -> list[Message]:
        """Publications for MQTT and reports for the plant, in the order they must leave."""
        out = self._start(now)
        for event in events:
            out += self._deliver(event) if isinstance(event, Delivery) else self._take(event)
        if min(self._stale_at.values(), default=math.inf) <= now:
            out += self._lose_silent(now)
        return out + self._own_beats(now)

    def _start(self, now: float) -> list[Message]:
        if self._started_at == math.inf:
            return []
        self._started_at = math.inf
        return [board.no_link(now) for board in self._boards.values()]

    def _take(self, event: FromPlant | Connection | Leaving) -> list[Message]:
        if isinstance(event, Connection):
            self.connected = event.up
            changed = [board.connection(event.at, event.up) for board in self._boards.values()]
            self._stale_at = {name: board.link.stale_at for name, board in self._boards.items()}
            return [message for messages in changed for message in messages]
        if isinstance(event, Leaving):
            return [message for board in self._boards.values() for message in board.halt(event.at)]
        if isinstance(event.message, Heartbeat):
            return self._relay(event.at, event.message)
        return self._command(event.at, event.message)

    def _deliver(self, delivery: Delivery) -> list[Message]:
        route = self._routes.get(delivery.topic)
        if route is None:
            return self._stray(_strange(delivery.topic))
        name, board, channel = route
        out = board.deliver(delivery, channel)
        self._stale_at[name] = board.link.stale_at
        return out

    def _lose_silent(self, now: float) -> list[Message]:
        out: list[Message] = []
        for name, board in self._boards.items():
            if self._stale_at[name] <= now:
                out += board.lose(now)
                self._stale_at[name] = board.link.stale_at
        return out

    def _stray(self, sentence: str) -> list[Message]:
        self._strays = Counters(refused=self._strays.refused + 1, last=sentence)
        return []

    def _command(self, at: float, command: Command) -> list[Message]:
        board = self._boards.get(command.robot)
        if board is None:
            return self._nobody(at, command)
        word = self._fence(command)
        return board.refuse(at, command, word) if word else board.command(at, command)

    def _nobody(self, at: float, command: Command) -> list[Message]:
        self._stray(f"{command.robot!a} is no robot that this bridge reaches")
        return [
            Report(
                at=at,
                robot=command.robot,
                epoch=self._epoch,
                rejected=command.id or None,
                refusal="no_link" if command.id else None,
            )
        ]

    def _fence(self, command: Command) -> str | None:
        """The word that refuses any plant but the one that beats; never a stop, nor an unlabelled command."""
        if not command.id:
            return None
        match = _ID.fullmatch(command.id)
        if match is None:
            return "formato"
        if isinstance(command, Stop) and command.mode is not StopMode.CLEAR:
            return None
        return None if int(match[1]) == self._plant_epoch else "old_epoch"

    def _relay(self, at: float, heartbeat: Heartbeat) -> list[Message]:
        if heartbeat.epoch < self._plant_epoch:
            return []
        self._plant_epoch = heartbeat.epoch
        self._plant_beats = True
        news = [report for board in self._boards.values() for report in board.hear_plant(at, heartbeat.epoch)]
        return [*news, *self._beat_all()]

    def _beat_all(self) -> list[Message]:
        return [board.beat() for board in self._boards.values() if board.in_motion]

    def _own_beats(self, now: float) -> list[Message]:
        """For an orchestrator that knows no heartbeat: the bridge answers for it while it is there itself."""
        if self._plant_beats or not any(board.in_motion for board in self._boards.values()):
            self._beat_at = math.inf
            return []
        if now < self._beat_at < math.inf:
            return []
        due, self._beat_at = self._beat_at < math.inf, now + BEAT_S
        return self._beat_all() if due else []


def _strange(topic: str) -> str:
    """Why a topic is not one of a board of this plant."""
    try:
        name, _ = topics.parse(topic)
    except PayloadError as error:
        return str(error)
    return f"{name} is no robot of this plant"
