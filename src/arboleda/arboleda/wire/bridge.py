"""The bridge: commands of the plant to MQTT, telemetry of the boards to reports.

A pure machine; one `Board` per robot does the work, this file routes and keeps what all share:
the plant's epoch and the heartbeat.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from arboleda.model.commands import Command, Stop
from arboleda.model.errors import PayloadError
from arboleda.model.messages import Heartbeat, Report
from arboleda.model.outside import quoted
from arboleda.model.plant_model import ForeignCommands, Link, PlantModel
from arboleda.model.sentence import as_sentence

from . import epochs, rejections, topics
from .board import Board, Counters, Message
from .hop import FromPlant, is_stop, loses_its_id, without_id
from .rejections import FOREIGN, Rejection
from .topics import Channel
from .transport import Connection, Delivery

BEAT_S = 0.25
PLANT_GONE_S = 5.0  # without a heartbeat: a plant that is only slow still commands its robots
UNSURE_S = 0.2  # in which the original of a copy arrives that overtook it
_ID = re.compile(r"(\d{1,10})-\d{1,10}", re.ASCII)


@dataclass(frozen=True, kw_only=True)
class Leaving:
    """The bridge is about to end; nobody will hear what its boards report."""

    at: float


@dataclass(frozen=True, kw_only=True)
class UnconfirmedCopy:
    """A command without an id that is told of at `due`, if it has not turned out to be a copy by then.

    `told`: there is nothing to tell, or it was told at once.
    """

    due: float
    board: Board
    event: FromPlant
    refused: bool
    told: bool


Event = FromPlant | Delivery | Connection | Leaving


class Bridge:
    """`epoch` is Unix seconds at this start; a board that has heard a higher one raises its own.

    `subscriptions` are the topics to subscribe to, of every robot that speaks MQTT; `now` is the time of its
    last step.
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
        self.now = now
        self._stale_after_s = stale_after_s
        self._started_at = now  # never again once that was told
        self._plant_epoch = 0
        self._plant_beats = False
        self._plant_heard_at = -math.inf
        self._refuses_others = model.foreign_commands is ForeignCommands.REFUSE
        self._unsure: list[UnconfirmedCopy] = []
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
        if self._unsure:
            due = min(due, *(each.due for each in self._unsure if not each.told), math.inf)
        return due if due < math.inf else None

    def step(self, now: float, events: Sequence[Event]) -> list[Message]:
        """Publications for MQTT and reports for the plant, in the order they must leave."""
        self.now = now
        out = self._start(now)
        for event in events:
            out += self._deliver(event) if isinstance(event, Delivery) else self._take(event)
        if min(self._stale_at.values(), default=math.inf) <= now:
            out += self._lose_silent(now)
        if self._unsure:
            out += self._no_copies(now)
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
            if (objection := epochs.objection(event.message.epoch, event.unix_s)) is not None:
                return self._stray(objection)
            return self._relay(event.at, event.message)
        return self._command(event, event.message)

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
        self._strays = Counters(refused=self._strays.refused + 1, last=as_sentence(sentence))
        return []

    def _command(self, event: FromPlant, command: Command) -> list[Message]:
        board = self._boards.get(command.robot)
        if board is None:
            return self._nobody(event.at, command)
        if not command.id:
            return self._unlabelled(event, command, board)
        self._expect_copy(event, command, board)
        word = self._fence(command) or self._late(event.at, command)
        return board.refuse(event.at, command, word) if word else board.command(event.at, command)

    def _expect_copy(self, event: FromPlant, command: Command, board: Board) -> None:
        """The plant says whether it copies; a copy that came before its original is nobody else's."""
        if loses_its_id(command):
            board.copies.flow = event.copied
        if not event.copied:
            return
        plain = without_id(command)
        early = next((each for each in self._unsure if each.event.message == plain), None)
        if early is None:
            board.copies.expect(event.at, command)
        else:
            self._unsure.remove(early)

    def _unlabelled(self, event: FromPlant, command: Command, board: Board) -> list[Message]:
        """A copy of what the plant said, or a command of somebody else."""
        at, sender = event.at, event.sender
        if board.copies.take(at, command):
            return []
        if (late := self._late(at, command)) is not None:
            return board.refuse(at, command, late, sender)
        commanded = self._is_commanded(at)
        refused = commanded and self._refuses_others and not is_stop(command)
        out = [] if refused else board.command(at, command, sender)
        told = not commanded or any(isinstance(each, Rejection) for each in out)
        unsure = UnconfirmedCopy(due=at + UNSURE_S, board=board, event=event, refused=refused, told=told)
        if not told and not board.copies.flow:
            out += self._told_of(unsure)
            unsure = replace(unsure, told=True)
        self._unsure.append(unsure)
        return out

    def _is_commanded(self, at: float) -> bool:
        """Whether a plant is heard, whose robots nobody else commands."""
        return at < self._plant_heard_at + PLANT_GONE_S

    def _no_copies(self, now: float) -> list[Message]:
        due = [each for each in self._unsure if each.due <= now]
        self._unsure = [each for each in self._unsure if each.due > now]
        return [message for each in due for message in self._told_of(each)]

    def _told_of(self, unsure: UnconfirmedCopy) -> list[Message]:
        if unsure.told:
            return []
        board, event = unsure.board, unsure.event
        assert not isinstance(event.message, Heartbeat)
        if unsure.refused:
            out = board.refuse(event.at, event.message, FOREIGN, event.sender)
            return [*out, *board.told_of(event.at, board.counters.last, refused=True)]
        sentence = rejections.obeyed(board.robot, event.message, event.sender)
        return board.told_of(event.at, sentence, refused=False)

    def _nobody(self, at: float, command: Command) -> list[Message]:
        self._stray(f"{quoted(command.robot)} is no robot that this bridge reaches")
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
        """The word that refuses any plant but the one that beats; never a stop."""
        match = _ID.fullmatch(command.id)
        if match is None:
            return "formato"
        if is_stop(command):
            return None
        return None if int(match[1]) == self._plant_epoch else "old_epoch"

    def _late(self, at: float, command: Command) -> str | None:
        """The word that refuses what lay here while this process did nothing; a stop is never too late."""
        late = self.now - at > self._stale_after_s
        return "no_link" if late and not isinstance(command, Stop) else None

    def _relay(self, at: float, heartbeat: Heartbeat) -> list[Message]:
        if heartbeat.epoch < self._plant_epoch:
            return []
        self._plant_epoch = heartbeat.epoch
        self._plant_beats = True
        self._plant_heard_at = at
        news = [report for board in self._boards.values() for report in board.hear_plant(at, heartbeat.epoch)]
        return [*news, *self._beat_all(), *self._fence_all()]

    def _fence_all(self) -> list[Message]:
        """Until each board says that it takes nothing older: what came before may still be on the wire."""
        return [beat for board in self._boards.values() if not board.in_motion for beat in board.fence()]

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
