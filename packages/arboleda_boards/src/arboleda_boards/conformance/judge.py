"""The judge: a pure machine that makes one check after the other and keeps their results."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import Any

from arboleda.drivers import Arm, Device, Evidence, Robot
from arboleda.model.by_class import nearest
from arboleda.wire import payloads
from arboleda.wire.topics import Channel
from arboleda.wire.transport import Delivery

from . import beat_checks as beat
from . import device_checks as device
from . import device_number_checks as device_number
from . import motion_checks as motion
from . import number_checks as number
from .arm_bench import ArmBench
from .arm_procedures import ready
from .bench import Bench, CheckFailed, CheckSkipped, Jostle, Send, Steps, Wait
from .device_bench import DeviceBench
from .procedures import settle

BEAT_S = 0.25
GONE_S = 15.0  # a board that reports 10 times a second, and may take 10 s to connect again, is heard before
GONE = f"nothing was heard of the board for {GONE_S:g} s"
LEVELS = (Evidence.STATE, Evidence.JOINTS, Evidence.IDS)  # each includes those before it


@dataclass(frozen=True, kw_only=True)
class Check:
    """A check and the level that needs it; the docstring of its steps says what a board has to do."""

    name: str
    level: Evidence
    steps: Callable[[Any], Steps]


@dataclass(frozen=True, kw_only=True)
class Finding:
    """The result of a check: `wrong` speaks against the board, `untried` is why it was not made."""

    check: Check
    wrong: str | None = None
    untried: str | None = None


CHECKS = (
    Check(name="telemetry", level=Evidence.STATE, steps=motion.telemetry),
    Check(name="moves", level=Evidence.STATE, steps=motion.moves),
    Check(name="rhythm", level=Evidence.JOINTS, steps=motion.rhythm),
    Check(name="reaches", level=Evidence.JOINTS, steps=motion.reaches),
    Check(name="rounds", level=Evidence.JOINTS, steps=motion.rounds),
    Check(name="halts", level=Evidence.JOINTS, steps=motion.halts),
    Check(name="malformed", level=Evidence.JOINTS, steps=motion.malformed),
    Check(name="limits", level=Evidence.JOINTS, steps=motion.limits),
    Check(name="numbers", level=Evidence.IDS, steps=number.numbers),
    Check(name="telling", level=Evidence.IDS, steps=number.telling),
    Check(name="duplicate", level=Evidence.IDS, steps=number.duplicate),
    Check(name="old", level=Evidence.IDS, steps=number.old),
    Check(name="old epoch", level=Evidence.IDS, steps=number.old_epoch),
    Check(name="new epoch", level=Evidence.IDS, steps=number.new_epoch),
    Check(name="beaten off", level=Evidence.IDS, steps=beat.beaten_off),
    Check(name="stamped", level=Evidence.IDS, steps=number.stamped),
    Check(name="late", level=Evidence.IDS, steps=number.late),
    Check(name="token", level=Evidence.IDS, steps=number.token),
    Check(name="words", level=Evidence.IDS, steps=number.words),
    Check(name="retained", level=Evidence.IDS, steps=number.retained),
    Check(name="halted", level=Evidence.IDS, steps=number.halted),
    Check(name="stop from anybody", level=Evidence.IDS, steps=number.stop_from_anybody),
    Check(name="latch", level=Evidence.IDS, steps=number.latch),
    Check(name="retarget", level=Evidence.IDS, steps=number.retarget),
    Check(name="silence", level=Evidence.IDS, steps=number.silence),
    Check(name="effector", level=Evidence.IDS, steps=number.effector),
    Check(name="homing", level=Evidence.IDS, steps=number.homing),
    Check(name="far future", level=Evidence.IDS, steps=beat.far_future),  # last: who fails it obeys nobody
)

DEVICE_CHECKS = (
    Check(name="telemetry", level=Evidence.STATE, steps=motion.telemetry),
    Check(name="works", level=Evidence.STATE, steps=device.works),
    Check(name="rhythm", level=Evidence.JOINTS, steps=motion.rhythm),
    Check(name="facts", level=Evidence.JOINTS, steps=device.facts),
    Check(name="verbs", level=Evidence.JOINTS, steps=device.verbs),
    Check(name="halts", level=Evidence.JOINTS, steps=device.halts),
    Check(name="malformed", level=Evidence.JOINTS, steps=device.malformed),
    Check(name="unknown", level=Evidence.JOINTS, steps=device.unknown),
    Check(name="numbers", level=Evidence.IDS, steps=device_number.numbers),
    Check(name="telling", level=Evidence.IDS, steps=device_number.telling),
    Check(name="duplicate", level=Evidence.IDS, steps=device_number.duplicate),
    Check(name="old", level=Evidence.IDS, steps=device_number.old),
    Check(name="old epoch", level=Evidence.IDS, steps=device_number.old_epoch),
    Check(name="new epoch", level=Evidence.IDS, steps=device_number.new_epoch),
    Check(name="beaten off", level=Evidence.IDS, steps=beat.beaten_off),
    Check(name="stamped", level=Evidence.IDS, steps=device_number.stamped),
    Check(name="late", level=Evidence.IDS, steps=device_number.late),
    Check(name="token", level=Evidence.IDS, steps=device_number.token),
    Check(name="words", level=Evidence.IDS, steps=device_number.words),
    Check(name="needs", level=Evidence.IDS, steps=device_number.needs),
    Check(name="busy", level=Evidence.IDS, steps=device_number.busy),
    Check(name="queries", level=Evidence.IDS, steps=device_number.queries),
    Check(name="retained", level=Evidence.IDS, steps=device_number.retained),
    Check(name="halted", level=Evidence.IDS, steps=device_number.halted),
    Check(name="stop from anybody", level=Evidence.IDS, steps=device_number.stop_from_anybody),
    Check(name="latch", level=Evidence.IDS, steps=device_number.latch),
    Check(name="silence", level=Evidence.IDS, steps=device_number.silence),
    Check(name="far future", level=Evidence.IDS, steps=beat.far_future),  # last: who fails it obeys nobody
)


def _no_reference(bench: DeviceBench) -> Steps:
    """A device has no reference to look for."""
    yield from ()


@dataclass(frozen=True, kw_only=True)
class Course:
    """The course of checks for boards of one class of robot; `ready` prepares the board for each check."""

    bench: Callable[[Any, int], Bench[Any]]
    checks: tuple[Check, ...]
    ready: Callable[[Any], Steps]


COURSES: dict[type[Robot], Course] = {
    Arm: Course(bench=ArmBench, checks=CHECKS, ready=ready),
    Device: Course(bench=DeviceBench, checks=DEVICE_CHECKS, ready=_no_reference),
}


class Judge:
    """Events are what the board published; messages are `Send` and `Jostle`. `over` when all is known.

    `is_gone` once a board that reports all the time has fallen silent: nothing more is tried then.
    """

    def __init__(self, robot: Robot, *, epoch: int, now: float) -> None:
        course = nearest(COURSES, type(robot))
        if course is None:
            raise TypeError(f"nothing says what the board of {robot.name} has to do")
        self.bench, self.checks, self._ready = course.bench(robot, epoch), course.checks, course.ready
        self.findings: list[Finding] = []
        self.current: Check | None = None
        self.over = self.is_gone = False
        self._course = self._all()
        self._wait = Wait(seconds=0.0)
        self._deadline = self._beat_at = now

    @property
    def next_deadline(self) -> float | None:
        if self.over:
            return None
        beats = [self._beat_at] if self.bench.beating else []
        return min(self._deadline, self._gone_at, *beats)

    @property
    def spoken(self) -> Evidence:
        """The level that the board's reports belong to."""
        return self.bench.spoken

    @property
    def reached(self) -> Evidence | None:
        """The highest level whose checks, and those of the levels below, speak for the board."""
        wrong = [LEVELS.index(finding.check.level) for finding in self.findings if finding.wrong]
        lowest = min([*wrong, LEVELS.index(self.spoken) + 1])
        return LEVELS[lowest - 1] if lowest > 0 else None

    def step(self, now: float, events: Sequence[Delivery]) -> list[Send | Jostle]:
        """Take the board's messages, and do what is due."""
        for event in events:
            self.bench.hear(event)
        self.bench.now = max(self.bench.now, now)
        if now >= self._gone_at and self.current is not None and not self.over:
            self.findings.append(Finding(check=self.current, untried=GONE))
            self.over = self.is_gone = True
        out = self._beat(now)
        while not self.over:
            met = self._wait.until()
            if not met and now < self._deadline:
                break
            out += self._resume(now, met)
        return out

    @property
    def _gone_at(self) -> float:
        """The time from which on the board counts as gone; one that says only its state may be silent."""
        return math.inf if self.spoken is Evidence.STATE else self.bench.last.at + GONE_S

    def _beat(self, now: float) -> list[Send | Jostle]:
        if not self.bench.beating or now < self._beat_at:
            return []
        self._beat_at = now + BEAT_S
        return [Send(channel=Channel.BEAT, payload=payloads.encode(payloads.Beat(epoch=self.bench.epoch)))]

    def _resume(self, now: float, met: bool) -> list[Send | Jostle]:
        """Run the check on to its next wait, and collect what it sends on the way."""
        out: list[Send | Jostle] = []
        try:
            step = self._course.send(met if self.current else None)
            while not isinstance(step, Wait):
                out += [*self._beat(now), step]
                step = next(self._course)
            self._wait, self._deadline = step, now + step.seconds
        except StopIteration:
            self.over = True
        return out

    def _all(self) -> Generator[Send | Jostle | Wait, Any, None]:
        for check in self.checks:
            self.current = check
            if LEVELS.index(check.level) > LEVELS.index(self.spoken):
                return
            yield from self._try(check)
            if not self.bench.reports:
                return

    def _try(self, check: Check) -> Generator[Send | Jostle | Wait, Any, None]:
        """Run one check, then restore the state from which the next one can begin."""
        wrong = untried = None
        try:
            yield from check.steps(self.bench)
        except CheckFailed as found:
            wrong = str(found)
        except CheckSkipped as reason:
            untried = str(reason)
        if self.bench.reports:
            wrong = (yield from self._settled(check)) or wrong
        self.findings.append(Finding(check=check, wrong=wrong, untried=untried))

    def _settled(self, check: Check) -> Generator[Send | Jostle | Wait, Any, str | None]:
        try:
            yield from settle(self.bench)
            yield from self._ready(self.bench)
        except CheckFailed as found:
            return f"afterwards {found}"
        return None
