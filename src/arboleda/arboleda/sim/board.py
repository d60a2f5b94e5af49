"""Virtual ESP32: a board's command rules, stop latch, heartbeat watch and telemetry."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, ClassVar

from arboleda.model import refusals
from arboleda.model.commands import StopMode
from arboleda.model.errors import PayloadError
from arboleda.model.messages import MotionState
from arboleda.model.plant_model import Evidence, Robot
from arboleda.wire import strict
from arboleda.wire.payloads import (
    Beat,
    EffectorGoal,
    Goal,
    HomeGoal,
    JointsGoal,
    PathGoal,
    Presence,
    StopGoal,
    Telemetry,
    VerbGoal,
    decode,
)
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Delivery, Publication

from .body import Body, BodyReport, SeenState
from .freshness import Freshness
from .machine import SUPERSEDED, UNSHOWN
from .receipts import Receipts
from .uplink import Uplink

SILENCE_US = 1_000_000  # without beat or command while moving: ramp to a stop
KNOWN_ORDERS = 8  # a machine may do several things at once, and any of them may be told again
SILENCE, ALARM = "silencio", "alarma"  # words for the reasons why a machine gives up its work


class Board:
    """Virtual board as a pure machine: calls in, publications collected until `take`.

    It reports what its robot's declared evidence level allows, and knows command numbers at `ids` only.
    `watch`, if set, is called with every command that the board carries out. `words` are all with which a
    command is refused on its way or given up, as long as nothing goes wrong with the board.
    """

    words: ClassVar = frozenset({*refusals.WORDS, SILENCE, SUPERSEDED, UNSHOWN})

    def __init__(self, robot: Robot, body: Body, *, boot_id: int, now_us: int) -> None:
        self.body = body
        self.refusals = 0  # messages rejected whole since power-up
        self.watch: Callable[[Goal], None] | None = None
        self._numbered = robot.evidence is Evidence.IDS
        self._tells_facts = robot.evidence is not Evidence.STATE
        self._assume_homed = robot.assume_homed or not body.homes
        self._knows = 1 if body.homes else KNOWN_ORDERS
        channels = body.channels if robot.has_stop else body.channels - {Channel.STOP}
        self._channels = {topic(robot.mqtt, channel): channel for channel in Channel if channel in channels}
        self._now_us = now_us
        self._uplink = Uplink(robot.mqtt)
        self._last_state: tuple[Any, ...] | None = None  # values of the last telemetry
        self._boot(boot_id, homed=True)

    def _boot(self, boot_id: int, *, homed: bool) -> None:
        self.boot_id = boot_id
        self.homed = homed
        self.latched = False
        self.faulted = False
        self._job: Goal | None = None  # the motion that will count as done when the body comes to rest
        self._receipts = Receipts(known=self._knows)
        self._uplink.sent = 0
        self._freshness = Freshness()
        self._beaten = False
        self._alive_us = self._now_us

    @property
    def subscriptions(self) -> tuple[str, ...]:
        return tuple(self._channels)

    @property
    def state(self) -> MotionState:
        if self.body.next_change_us is not None and self.body.moving:
            return MotionState.MOVING
        if self.faulted:
            return MotionState.FAULT
        if self.latched:
            return MotionState.STOP_LATCHED
        return MotionState.STOPPED if self.homed else MotionState.NOT_HOMED

    @property
    def least_epoch(self) -> int | None:
        """The oldest epoch whose commands the board takes; None: any."""
        return self._receipts.least

    @property
    def next_deadline_us(self) -> int | None:
        due_us = self._uplink.due_us
        if self.body.next_change_us is not None:
            due_us = min(due_us, self._next_motion_us())
        return None if due_us == math.inf else int(due_us)

    def take(self) -> list[Publication]:
        """The messages published since the last call, in order."""
        return self._uplink.take()

    def connect(self, now_us: int, up: bool) -> None:
        """Note that the board's MQTT client reached or lost its broker."""
        self.advance(now_us)
        self._uplink.connected = up
        self._announce()

    def reboot(self, now_us: int, boot_id: int) -> None:
        """Lose power and start again: numbers, position, latch and grip are gone."""
        self.advance(now_us)
        self.body.reset()
        self._boot(boot_id, homed=self._assume_homed)
        self._announce()

    def put_at_reference(self) -> None:
        """Move the resting robot by hand to where its counters begin.

        A board without command numbers is not told to home; who stands beside it says so at the board.
        """
        self.body.put_at_reference()
        self.homed = self.homed or not self._numbered

    def place(self, seen: SeenState, *, holds: bool, homed: bool | None, latched: bool) -> None:
        """Put the resting robot into the state in which another one was seen."""
        self.body.place(seen, holds=holds)
        self.homed = self.homed if homed is None else homed
        self.latched = latched

    def fail(self, now_us: int) -> None:
        """Raise an alarm of a driver: the board ramps to a stop and moves nothing until `repair`."""
        self.advance(now_us)
        self.faulted = True
        self._break_off(ALARM)
        self._tell()

    def repair(self, now_us: int) -> None:
        """End the alarm."""
        self.advance(now_us)
        self.faulted = False
        self._tell()

    def advance(self, now_us: int) -> None:
        """Let time pass; a time before the last one seen counts as that."""
        if now_us < self._now_us:
            now_us = self._now_us
        if self.body.next_change_us is not None:
            self._move(now_us)
        self._now_us = now_us
        if self._uplink.due_us <= now_us:
            self._uplink.next_period(now_us)
            self._tell()

    def receive(self, now_us: int, delivery: Delivery) -> None:
        """Take a message of a subscribed topic; an invalid one changes nothing but the refusal."""
        self.advance(now_us)
        channel = self._channels.get(delivery.topic)
        if channel is None:
            return
        try:
            message = decode(channel, delivery.payload, axes=self.body.axes)
        except PayloadError:
            self._refuse(refusals.FORMAT, *_numbers_in(delivery.payload))
            return
        if delivery.retain:
            self._refuse(refusals.RETAINED, *_numbers_in(delivery.payload))
        elif isinstance(message, Beat):
            self._hear(message)
        elif not isinstance(message, (Telemetry, Presence)):
            self._obey(message)

    def _hear(self, beat: Beat) -> None:
        """Take a heartbeat; one of the newest epoch keeps alive the work begun under that epoch."""
        receipts = self._receipts
        if self._numbered and not receipts.hear(beat.epoch):
            self._refuse(refusals.FORMAT, None, beat.epoch)
        elif not self._numbered or beat.epoch == receipts.least:
            self._beaten = True
            self._alive_us = self._now_us if receipts.epoch in (None, beat.epoch) else self._alive_us

    def _obey(self, goal: Goal) -> None:
        if isinstance(goal, StopGoal) and goal.mode is not StopMode.CLEAR:
            self._stop(latch=goal.mode is StopMode.LATCH)
        if self._numbered and self._receipts.repeats(goal):
            self._tell()
            return
        objection = self._receipts.objection(goal) if self._numbered else None
        refusal = objection or self._refusal(goal)
        if refusal:
            self._refuse(refusal, goal.seq, goal.epoch)
        else:
            self._accept(goal)

    def _accept(self, goal: Goal) -> None:
        self._alive_us = self._now_us
        self._receipts.accept(goal)
        self._act(goal)
        if self.watch is not None:
            self.watch(goal)
        self._tell()

    def _refusal(self, goal: Goal) -> str | None:
        """The word for a command with a good number that the board must not carry out now; None if it may."""
        if isinstance(goal, StopGoal):
            return None
        in_time = goal.heard is None or self._freshness.covers(self._now_us, goal.heard)
        return self._objection(goal) or (None if in_time else refusals.LATE)

    def _objection(self, goal: Goal) -> str | None:
        """The word with which the board's state refuses a command; None if it can be carried out."""
        if isinstance(goal, EffectorGoal) and not goal.on:
            return None
        if isinstance(goal, VerbGoal):
            return self.body.objection(goal, latched=self.latched, faulted=self.faulted)
        if self.latched:
            return refusals.STOPPED
        if isinstance(goal, EffectorGoal):
            return None
        if self.faulted or isinstance(self._job, HomeGoal):
            return refusals.BUSY
        if isinstance(goal, HomeGoal):
            return None
        if not self.homed:
            return refusals.NOT_HOMED
        return None if self.body.admits(goal) else refusals.LIMIT

    def _act(self, goal: Goal) -> None:
        if isinstance(goal, (JointsGoal, PathGoal)):
            self.body.start(self._now_us, goal)
            self._job = goal
        elif isinstance(goal, VerbGoal):
            self.body.start(self._now_us, goal)
            self._job = goal if self.body.is_work(goal) else self._job
            self._book_ends()
        elif isinstance(goal, HomeGoal):
            self.body.home(self._now_us)
            self._job = goal
            self.homed = False
        elif isinstance(goal, EffectorGoal):
            self.body.switch_effector(goal.on)
        elif goal.mode is StopMode.CLEAR:
            self.latched = False

    def _stop(self, *, latch: bool) -> None:
        self.latched = self.latched or latch
        if not self.body.finishes:
            self._break_off()

    def _break_off(self, word: str | None = None) -> None:
        """End the present work; with a word, the board itself did so."""
        job, self._job = self._job, None
        if self.body.moving and job is not None:  # a second stop would begin the ramp down anew
            self.body.stop(self._now_us)
        if word is not None and isinstance(job, VerbGoal):
            self._receipts.fail(job, word)

    def _next_motion_us(self) -> int:
        """The time (us) at which a moving body arrives, or at which a watched silence gets too long."""
        change_us = self.body.next_change_us
        assert change_us is not None
        if not self._beaten or self._job is None or self.body.finishes:
            return change_us
        return min(change_us, self._alive_us + SILENCE_US)

    def _move(self, until_us: int) -> None:
        while self.body.next_change_us is not None and (due := self._next_motion_us()) <= until_us:
            self._now_us = max(due, self._now_us)
            self._move_on()
        self.body.advance(until_us)

    def _move_on(self) -> None:
        """Handle an arrival, or the end of patience, at the board's present time."""
        self.body.advance(self._now_us)
        if self.body.ends:
            self._book_ends()
        if not self.body.moving:
            self._finish()
        elif self._next_motion_us() <= self._now_us:
            self._break_off(SILENCE)
        self._tell()

    def _book_ends(self) -> None:
        for end in self.body.take_ends():
            if end.failure is not None:
                self._receipts.fail(end.goal, end.failure)
                self._job = None if self._job is end.goal else self._job
            elif end.answer is not None:
                self._receipts.answered(end.goal, end.answer)

    def _finish(self) -> None:
        job, self._job = self._job, None
        if job is None:
            return
        self._receipts.finish(job)
        self.homed = self.homed or isinstance(job, HomeGoal)

    def _refuse(self, word: str, seq: int | None, epoch: int | None) -> None:
        self.refusals += 1
        self._receipts.refuse(word, seq, epoch)
        self._tell()

    def _announce(self) -> None:
        self._uplink.announce(self._now_us)
        self._tell()

    def _tell(self) -> None:
        """Send telemetry; a message equal to the last one but for its number is not built anew."""
        report = self.body.tell()
        state = (report, self.state, self.boot_id, self.homed, self._receipts.words)
        last, self._last_state = self._last_state, state
        if not self._uplink.connected:
            self._last_state = None
        elif state == last:
            self._uplink.tell_again()
        elif last is not None and report.q_deg is not None and _joints_apart(state) == _joints_apart(last):
            self._uplink.tell_angles(report.q_deg)
        else:
            self._uplink.tell(self._telemetry(report))
        if self._uplink.connected:
            self._freshness.tell(self._now_us, self._uplink.sent)

    def _telemetry(self, report: BodyReport) -> Telemetry:
        receipts = self._receipts
        if not self._numbered:
            facts = report.facts if self._tells_facts else None
            return Telemetry(state=self.state, q_deg=report.q_deg, node=report.node, facts=facts)
        return Telemetry(
            state=self.state,
            q_deg=report.q_deg,
            node=report.node,
            effector=report.effector,
            piece=report.piece,
            seq=0,
            ack_epoch=receipts.epoch,
            least_epoch=receipts.least if receipts.least != receipts.epoch else None,
            ack=receipts.accepted,
            done=receipts.finished,
            ack_token=receipts.accepted_token,
            done_token=receipts.finished_token,
            refusal=receipts.refusal,
            refused_seq=receipts.refused,
            boot_id=self.boot_id,
            homed=self.homed if self.body.homes else None,
            facts=report.facts,
            answer=receipts.answer[1] if receipts.answer else None,
            answered_seq=receipts.answer[0] if receipts.answer else None,
            failures=receipts.failures or None if report.facts is not None else None,
        )


def _joints_apart(state: tuple[Any, ...]) -> tuple[object, ...]:
    report, *rest = state
    return (report[1:], *rest)


def _numbers_in(raw: bytes) -> tuple[int | None, int | None]:
    """The seq and epoca of a message that is refused whole, as far as they can be read."""
    try:
        fields = strict.read(raw)
        return fields.optional("seq"), fields.optional("epoca")
    except PayloadError:
        return None, None
