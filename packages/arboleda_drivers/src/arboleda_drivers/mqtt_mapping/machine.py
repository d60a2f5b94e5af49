"""State machine of one device that is mapped by its topics: commands become messages, messages reports.

An order is open until its end is heard, a stop is sent, or the next order. Only what is heard after it was
sent can be of it, and a retained message never is.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from arboleda.drivers import (
    Command,
    Device,
    Effect,
    MotionState,
    NotSent,
    OnStop,
    Report,
    Robot,
    Stop,
    StopMode,
    Value,
    VerbCommand,
    Work,
    lost,
    plain,
)
from arboleda.wire.transport import Delivery, Publication
from arboleda_drivers.connections.link import LogLine
from arboleda_drivers.meaning import UnreadableValue
from arboleda_drivers.paths import NOTHING

from .heard import Says
from .keys import Keys
from .link import Link
from .sent import DEVICE, ID, MOST, NUMBER, Sent
from .showing import Showing

BEAT_S = 0.3  # period of reports of what is known
ASK_S = 5.0  # between two tries to have it tell what is not known
ASK_AT_WORK_S = 1.0  # the same while it is at work
LONGEST_WORD = 100
STANDS = (MotionState.STOPPED, MotionState.STOP_LATCHED)


Message = Report | Publication | LogLine


@dataclass(frozen=True, kw_only=True)
class Order:
    """Order under way, by its number at this device; its end may come until `late_at`.

    `is_named`: no late message can be taken for the end of another order.
    """

    command: VerbCommand
    number: int
    late_at: float
    is_named: bool

    @property
    def ids(self) -> tuple[str, str]:
        """The texts by which a message may name it."""
        return self.command.id, str(self.number)

    @property
    def is_work(self) -> bool:
        return isinstance(self.command, Work)

    @property
    def finishes(self) -> bool:
        """True for work that a stop does not end."""
        return isinstance(self.command, Work) and self.command.on_stop is OnStop.FINISH


class MappedDevice:
    """State machine of one device; `first` is the number of its first order.

    Numbers of two starts have to differ, as an old message may still name an old order.
    """

    def __init__(self, device: Device, settings: Keys, *, first: int = 1) -> None:
        self._device, self._settings = device, settings
        self._name = settings.name_of(device.name)
        self._link = Link(settings, self._name)
        self._showing = Showing(settings, device.kind, self._link)
        self._order: Order | None = None
        self._next = first
        self._latched = False
        self._stop: str | None = None  # the id of a stop until the device is known to stand
        self._receipts: dict[str, Any] = {}
        self._ask_at = -math.inf
        self.next_deadline = 0.0

    # Link and messages.

    def connected(self, now: float, *, up: bool) -> list[Message]:
        """Note that the broker is connected, or is lost."""
        self._link.connected(up=up)
        self._forget()
        return self._told(now)

    def step(self, now: float) -> list[Message]:
        """Report what is known, if that is due."""
        if now < self.next_deadline:
            return []
        if self._link.falls_silent(now):
            self._forget()
        return self._told(now)

    def heard(self, now: float, message: Delivery) -> list[Message]:
        """Take a message on one of its topics."""
        if message.retain and not message.payload:
            return []  # a retained message was taken away
        out: list[Message] = []
        try:
            if self._link.see(now, message):
                self._forget()
            wrong = self._showing.see(now, message)
            if not message.retain:
                self._see_order(message)
        except UnreadableValue as error:
            wrong = [str(error)]
        for each in wrong:
            out.append(LogLine(text=f"{self._device.name}: of a message on {message.topic}: {each}"))
        return [*out, *self._told(now)]

    def _forget(self) -> None:
        """Forget what was open: whatever is heard later may be of an order before."""
        self._order, self._stop, self._receipts = None, None, {}
        self._showing.forget()
        self._ask_at = -math.inf

    def _see_order(self, message: Delivery) -> None:
        """See what a message says of the order under way."""
        order, settings = self._order, self._settings
        if order is None:
            return
        id, verb = order.command.id, order.command.verb
        if self._says(settings.accepts(verb), message, order):
            self._receipts["accepted"] = id
        failed = settings.fails(verb)
        if failed is not None and self._says(failed, message, order):
            self._fail(id, verb, plain(failed.reason(message.payload) or "failed", LONGEST_WORD))
        elif order.command.definition.effect is Effect.QUERY:
            self._see_answer(message, order)
        elif self._says(settings.ends(verb), message, order):
            self._end(accepted=id, done=id)

    def _fail(self, id: str, verb: str, why: str) -> None:
        """End the order as failed; as refused where it says what it accepts, and did not accept it."""
        is_refused = self._settings.accepts(verb) is not None and self._receipts.get("accepted") != id
        self._end(**({"rejected": id, "refusal": why} if is_refused else {"failed": id, "failure": why}))

    def _says(self, says: Says | None, message: Delivery, order: Order) -> bool:
        is_on = self._link.is_on(says, message)
        return is_on and says is not None and says.is_said(message.payload, order.ids, message.about)

    def _see_answer(self, message: Delivery, order: Order) -> None:
        verb, id = self._settings.verbs[order.command.verb], order.command.id
        if verb.answer is None or not self._says(Says(hear=verb.answer.hear, id=verb.id), message, order):
            return
        if (raw := verb.answer.raw(message.payload)) is not NOTHING:
            answer = verb.answer.read(raw, order.command.definition.answer_type)
            self._end(accepted=id, answered=id, answer=answer)

    def _end(self, **receipts: Any) -> None:
        """End the order under way; whether the device still moves is told by its state."""
        self._receipts |= receipts
        self._order = None

    # Commands.

    def command(self, now: float, command: Command) -> list[Message]:
        """The messages that carry out a command; raises NotSent if that is impossible."""
        if not self._link.broker:
            raise NotSent(f"the MQTT broker at {self._settings.address} is not there")
        if isinstance(command, Stop):
            return [*self._filled(self._stopped(command), {}), *self._told(now)]
        if (why := self._hindrance(now)) is not None:
            raise NotSent(why)
        if not isinstance(command, VerbCommand) or command.verb not in self._settings.verbs:
            raise NotSent(f"nothing is sent for {command.word or 'this'}")
        number, self._next = self._next, self._next % MOST + 1
        late_at, is_named = now + 2 * command.at_most_s, self._is_named(command)
        order = Order(command=command, number=number, late_at=late_at, is_named=is_named)
        self._order, self._stop = order, None
        if order.is_work:
            self._showing.order(now)
        values: dict[str, Value] = {**dict(command.values), ID: command.id, NUMBER: number}
        return [*self._filled(self._settings.verbs[command.verb].send, values), *self._told(now)]

    def _hindrance(self, now: float) -> str | None:
        """The reason why no order is taken; None where one is."""
        if (why := self._trouble(now)) is not None:
            return why
        if self._latched:
            return f"{self._device.name} is stopped until it is cleared"
        order = self._order
        if order is None or order.is_named or now >= order.late_at:
            return None
        left_s = order.late_at - now
        what = f"{self._device.name} has not said yet that it has ended {order.command.verb}"
        return f"{what}, and what it says names no command; wait {left_s:.0f} s, or until it has"

    def _is_named(self, command: VerbCommand) -> bool:
        """True where no late message can be taken for the end of another order."""
        ends = self._settings.ends(command.verb)
        return ends is None or ends.names_command

    def unsent(self, command: Command) -> None:
        """Forget an order whose messages could not leave."""
        if self._order is not None and self._order.command is command:
            self._order = None

    def _stopped(self, stop: Stop) -> Sequence[Sent]:
        """Messages of a stop. Work that finishes goes on to its own end."""
        settings, order = self._settings, self._order
        if stop.mode is not StopMode.HALT:
            self._latched = stop.mode is StopMode.LATCH
        if stop.mode is StopMode.CLEAR:
            self._receipts["accepted"] = stop.id or None
            return settings.clear
        if order is not None and order.finishes:
            self._receipts["accepted"] = stop.id or None
            return ()
        self._order, self._stop = None, stop.id or None
        return (settings.latch or settings.halt) if stop.mode is StopMode.LATCH else settings.halt

    def _filled(self, sent: Sequence[Sent], values: dict[str, Value]) -> Iterator[Publication]:
        return (each.filled({**values, DEVICE: self._name}) for each in sent)

    # What the plant hears.

    def _trouble(self, now: float) -> str | None:
        state = self._settings.state
        if (why := self._link.trouble(now)) is not None or state is None:
            return why
        if self._showing.was_told:
            return None
        return f"{self._name} has not told its state yet on {state.named(self._name)}"

    def _motion(self, now: float) -> MotionState | None:
        order = self._order
        if self._settings.state is None and self._settings.still is None:
            at_work = order is not None and order.is_work
            state: MotionState | None = MotionState.MOVING if at_work else MotionState.STOPPED
        else:
            state = self._showing.motion(now)
            if state is None and order is not None and order.command.sets:
                shown = self._showing.has_shown(order.command.sets)
                state = MotionState.STOPPED if shown else None
        return MotionState.STOP_LATCHED if self._latched and state is MotionState.STOPPED else state

    def _is_at_work(self, now: float) -> bool:
        """True while it moves, or does not show yet what was ordered."""
        motion, order = self._motion(now), self._order
        if motion is MotionState.MOVING or order is None or now >= order.late_at:
            return motion is MotionState.MOVING
        return motion not in STANDS or not {*order.command.sets} <= {*self._showing.facts}

    def _told(self, now: float) -> list[Message]:
        self.next_deadline = now + BEAT_S
        return [*self._asked(now), self._report(now)]

    def _report(self, now: float) -> Report:
        if (why := self._trouble(now)) is not None:
            return lost(self._device.name, at=now, why=why)
        state = self._motion(now)
        if state in STANDS and self._stop is not None:
            self._receipts["accepted"], self._stop = self._stop, None
        return Report(
            at=now,
            robot=self._device.name,
            boot_id=self._link.boot,
            state=state,
            facts=self._showing.facts,
            unknown=self._showing.unknown,
            **self._receipts,
        )

    def _asked(self, now: float) -> Iterator[Publication]:
        """Messages that ask for its facts and state, where some are not known or are about to change."""
        is_at_work = self._is_at_work(now)
        if not self._link.broker or (self._showing.is_whole and not is_at_work):
            return
        if now < self._ask_at + (ASK_AT_WORK_S if is_at_work else ASK_S):
            return
        self._ask_at = now
        yield from self._filled(self._settings.ask, {})


def device_of(robot: Robot, settings: Keys, *, first: int) -> MappedDevice:
    """The machine of a device; raises ValueError for one that cannot be mapped."""
    if not isinstance(robot, Device):
        raise ValueError(f"{robot.name} is of no declared kind, so nothing can be mapped")
    return MappedDevice(robot, settings, first=first)
