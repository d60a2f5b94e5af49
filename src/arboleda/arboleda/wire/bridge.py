"""Bridge: commands of the plant to MQTT, telemetry of the boards to reports. A pure state machine.

One `Board` per robot does the work. This file routes messages, and has what all boards share: the plant's
epoch and the heartbeat.

A command without an id is a copy, or is of somebody else. Which of both shows only later, by whether its
original comes. So it is carried out or refused at once, and reported as foreign once that is certain. A stop
is never refused as foreign, late, or of another start.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from arboleda.model import refusals
from arboleda.model.commands import Command, Stop
from arboleda.model.errors import PayloadError
from arboleda.model.messages import Heartbeat, Report
from arboleda.model.outside import quoted
from arboleda.model.plant_model import ForeignCommands, Link, PlantModel
from arboleda.model.sentence import as_sentence

from . import epochs, rejections, topics
from .board import Board, Message
from .board_reports import Counters
from .copies import COPY_S
from .hop import FromPlant, is_stop, loses_its_id, without_id
from .rejections import Rejection
from .topics import Channel
from .transport import Connection, Delivery

BEAT_S = 0.25
PLANT_GONE_S = 5.0  # without a heartbeat; a plant that is only slow still commands its robots
UNSURE_S = 0.2  # within it the original arrives of a copy that overtook it
_ID = re.compile(r"(\d{1,10})-\d{1,10}", re.ASCII)


@dataclass(frozen=True, kw_only=True)
class Leaving:
    """Event: the bridge is about to end, and no further report will be heard."""

    at: float


@dataclass(frozen=True, kw_only=True)
class UnconfirmedCopy:
    """Command without an id, which is reported as foreign at `due` unless its original has come by then.

    `is_told`: the command was reported, or need not be. An original that comes before `until` brings no other
    copy.
    """

    due: float
    board: Board
    event: FromPlant
    refused: bool
    is_told: bool

    @property
    def until(self) -> float:
        """The time until which the original may come.

        Where only the plant publishes on the topic, the command is a copy, however long before its original
        it came. Where another node does, the command may be of that node, and the plant may soon give the
        same.
        """
        return self.due if self.event.sender else self.event.at + COPY_S


Event = FromPlant | Delivery | Connection | Leaving


class Bridge:
    """Bridge of all robots that speak MQTT; `subscriptions` are its topics, `now` the time of its last step.

    `epoch` is Unix seconds at this start; for a board that has heard a higher epoch, a higher one is used.
    `has_lease`: the plant leads by a lease in a shared store, so the bridge never yields a board.
    """

    def __init__(self, model: PlantModel, *, epoch: int, now: float, has_lease: bool = False) -> None:
        stale_after_s = model.timing.stale_after_s
        robots = [robot for robot in model.robots.values() if robot.link is Link.MQTT]
        self._boards = {
            robot.name: Board(robot, epoch=epoch, stale_after_s=stale_after_s, has_lease=has_lease)
            for robot in robots
        }
        self._stale_at = dict.fromkeys(self._boards, math.inf)  # deadline for the next message of each board
        self._routes = {
            topics.topic(board.robot.mqtt, channel): (name, board, channel)
            for name, board in self._boards.items()
            for channel in Channel
        }
        inbound = (Channel.TELEMETRY, Channel.PRESENCE)
        self.subscriptions = tuple(topic for topic, (*_, kind) in self._routes.items() if kind in inbound)
        self._epoch = epoch
        self.now = now
        self._stale_after_s = stale_after_s
        self._started_at = now  # inf once the start was reported
        self._plant_epoch = 0
        self._far_ahead = epochs.FarAhead()
        self._plant_beats = False
        self._plant_beat_at = -math.inf
        self._refuses_others = model.foreign_commands is ForeignCommands.REFUSE
        self._unsure: list[UnconfirmedCopy] = []
        self._beat_at = math.inf
        self._strays = Counters()
        self.connected = False

    @property
    def counters(self) -> dict[str, Counters]:
        """The counts of refused and dropped messages by robot; "" counts topics of no robot."""
        return {"": self._strays, **{name: board.reports.counters for name, board in self._boards.items()}}

    @property
    def next_deadline(self) -> float | None:
        """The time (s) at which `step` is due even without events; None if it never is."""
        due = min(self._started_at, self._beat_at, *self._stale_at.values())
        if self._unsure:
            due = min(due, *(each.due for each in self._unsure if not each.is_told), math.inf)
        return due if due < math.inf else None

    def step(self, now: float, events: Sequence[Event]) -> list[Message]:
        """Take events, and return publications for MQTT and reports for the plant, in order."""
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
        return [board.reports.no_link(now) for board in self._boards.values()]

    def _take(self, event: FromPlant | Connection | Leaving) -> list[Message]:
        if isinstance(event, Connection):
            self.connected = event.up
            changed = [board.connection(event.at, event.up) for board in self._boards.values()]
            self._stale_at = {name: board.link.stale_at for name, board in self._boards.items()}
            return [message for messages in changed for message in messages]
        if isinstance(event, Leaving):
            return [message for board in self._boards.values() for message in board.halt(event.at)]
        if isinstance(event.message, Heartbeat):
            return self._relay(event, event.message)
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
        """Expect a copy of a command, or match a copy that came before; note whether the plant copies."""
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
        """Take a command without an id: a copy of a command of the plant, or a foreign command."""
        at, sender = event.at, event.sender
        if board.copies.take(at, command):
            return []
        if (late := self._late(at, command)) is not None:
            self._unsure.append(UnconfirmedCopy(due=at, board=board, event=event, refused=True, is_told=True))
            return board.refuse(at, command, late, sender)
        commanded = self._is_commanded(at)
        refused = commanded and self._refuses_others and not is_stop(command)
        out = [] if refused else board.command(at, command, sender)
        is_told = not commanded or any(isinstance(each, Rejection) for each in out)
        unsure = UnconfirmedCopy(
            due=at + UNSURE_S, board=board, event=event, refused=refused, is_told=is_told
        )
        if not is_told and not board.copies.flow:
            out += self._report(unsure)
            unsure = replace(unsure, is_told=True)
        self._unsure.append(unsure)
        return out

    def _is_commanded(self, at: float) -> bool:
        """True while a plant is heard, which commands the robots."""
        return at < self._plant_beat_at + PLANT_GONE_S

    def _no_copies(self, now: float) -> list[Message]:
        out = [message for each in self._unsure if each.due <= now for message in self._report(each)]
        told = [replace(each, is_told=each.is_told or each.due <= now) for each in self._unsure]
        self._unsure = [each for each in told if each.until > now]
        return out

    def _report(self, unsure: UnconfirmedCopy) -> list[Message]:
        if unsure.is_told:
            return []
        board, event = unsure.board, unsure.event
        assert not isinstance(event.message, Heartbeat)
        if unsure.refused:
            out = board.refuse(event.at, event.message, refusals.FOREIGN, event.sender)
            return [*out, *board.report_foreign(event.at, board.reports.counters.last, refused=True)]
        sentence = rejections.obeyed(board.robot, event.message, event.sender)
        return board.report_foreign(event.at, sentence, refused=False)

    def _nobody(self, at: float, command: Command) -> list[Message]:
        self._stray(f"{quoted(command.robot)} is no robot that this bridge reaches")
        return [
            Report(
                at=at,
                robot=command.robot,
                epoch=self._epoch,
                rejected=command.id or None,
                refusal=refusals.NO_LINK if command.id else None,
            )
        ]

    def _fence(self, command: Command) -> str | None:
        """The word that refuses a command of another plant than the one that is heard; None for a stop."""
        match = _ID.fullmatch(command.id)
        if match is None:
            return refusals.FORMAT
        if is_stop(command):
            return None
        return None if int(match[1]) == self._plant_epoch else refusals.OLD_EPOCH

    def _late(self, at: float, command: Command) -> str | None:
        """The word that refuses a command that waited while this process was stopped; None for a stop."""
        late = self.now - at > self._stale_after_s
        return refusals.NO_LINK if late and not isinstance(command, Stop) else None

    def _relay(self, event: FromPlant, heartbeat: Heartbeat) -> list[Message]:
        at, heard = event.at, self._plant_epoch
        objection = self._far_ahead.objection(heartbeat.epoch, event.unix_s, heard=heard, at=at)
        if objection is not None:
            return self._stray(objection)
        if heartbeat.epoch < self._plant_epoch:
            return []
        self._plant_epoch = heartbeat.epoch
        self._plant_beats = True
        self._plant_beat_at = at
        news = [report for board in self._boards.values() for report in board.hear_plant(at, heartbeat.epoch)]
        return [*news, *self._beat_all(), *self._fence_all()]

    def _fence_all(self) -> list[Message]:
        """A heartbeat for each resting board that accepts older commands: some may still arrive."""
        return [beat for board in self._boards.values() if not board.in_motion for beat in board.fence()]

    def _beat_all(self) -> list[Message]:
        return [board.beat() for board in self._boards.values() if board.in_motion]

    def _own_beats(self, now: float) -> list[Message]:
        """Heartbeats of the bridge itself, for an orchestrator that sends none."""
        if self._plant_beats or not any(board.in_motion for board in self._boards.values()):
            self._beat_at = math.inf
            return []
        if now < self._beat_at < math.inf:
            return []
        due, self._beat_at = self._beat_at < math.inf, now + BEAT_S
        return self._beat_all() if due else []


def _strange(topic: str) -> str:
    try:
        name, _ = topics.parse(topic)
    except PayloadError as error:
        return str(error)
    return f"{name} is no robot of this plant"
