"""Watch over one device: it knows all that a virtual one can tell, and names what is not among that."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from arboleda.drivers import (
    Command,
    FollowPath,
    Home,
    Motion,
    MotionState,
    MoveJoints,
    OnStop,
    Report,
    Robot,
    Stop,
    StopMode,
    UseError,
    VerbCommand,
    Work,
)
from arboleda.sim.board import Board

from .difference import Difference, Spans
from .facts import PROMPT_S, FactWatch

SHARE = 0.25  # of a declared time, by which work may take longer or less
UNANSWERED_S = 5.0
EXCUSED_S = 10.0  # after somebody's hands, or another node, were at the device
MOST = 64  # commands that are followed at once
SIGNS = ("accepted", "rejected", "done", "failed", "answered")


@dataclass
class _Told:
    """Command that the device was told; `start` is where it was then."""

    command: Command
    at: float
    start: object
    heard_at: float | None = None  # the time of its first sign of it
    is_timed: bool = True
    is_over: bool = False  # halted, or overtaken by other work: it may still be told of


class DeviceWatch:
    """Watch over one device; times are those at which the plant was told, on its clock."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._ramp_s = _ramp_s(robot)
        self._spans = Spans(robot.name)
        self._facts = FactWatch(robot, self._spans)
        self._told: dict[str, _Told] = {}  # commands that have not ended, by id
        self._signs: dict[str, str] = {}  # the last id of each sign
        self._last: Report | None = None
        self._last_at = -math.inf
        self._ended_at = -math.inf  # of the last command
        self._has_stood = False
        self._stop_at: float | None = None  # a stop, until the device stands
        self._stopped_at = -math.inf
        self._has_moved = self._is_halted = False  # since the last stop
        self._excused_until = -math.inf

    # What it is told, and what befalls it.

    def give(self, command: Command, now: float) -> None:
        """Note a command that leaves for the device."""
        last = self._last
        if isinstance(command, Stop):
            finishes = any(each.on_stop is OnStop.FINISH for each in self._works)
            if command.mode is not StopMode.CLEAR and self._stop_at is None and not finishes:
                self._stop_at = self._stopped_at = now
                self._has_moved = last is not None and last.state is MotionState.MOVING
        elif isinstance(command, Work):
            self._end_works()
            self._stop_at, self._is_halted = None, False
        self._told[command.id] = _Told(command, now, None if last is None else _place(last))
        if len(self._told) > MOST:
            del self._told[next(iter(self._told))]

    def delay(self, id: str, late_s: float) -> None:
        """Note that a command left later."""
        if id in self._told:
            self._told[id].at += late_s

    def drop(self, id: str) -> None:
        """Note that a command has not left."""
        self._told.pop(id, None)

    def excuse(self, now: float) -> None:
        """Note that somebody else is at the device: what changes now is no word about it."""
        self._excused_until = now + EXCUSED_S

    @property
    def _under_way(self) -> list[Command]:
        return [each.command for each in self._told.values() if not each.is_over]

    @property
    def _works(self) -> list[Work]:
        return [each for each in self._under_way if isinstance(each, Work)]

    def _end_works(self) -> None:
        for each in self._told.values():
            each.is_over = each.is_over or isinstance(each.command, Work)

    def part(self, now: float) -> list[Difference]:
        """Note that nothing was heard of it: how long it took for anything is unknown."""
        for each in self._told.values():
            each.heard_at, each.is_timed = each.heard_at or now, False
        self._last, self._stop_at = None, None
        self._facts.part()
        return self._spans.end(now)

    def going_on(self, now: float) -> list[Difference]:
        """All that goes on, as it is by now."""
        return self._spans.until(now)

    # What it tells.

    def hear(self, report: Report, now: float) -> list[Difference]:
        """The differences in a report; those that last are there once they are over."""
        if report.state is MotionState.NO_LINK:
            return self.part(now)
        found = [*self._look_at_commands(report, now)]
        if report.state is None:  # by whoever stands between plant and device
            return found
        if self._has_booted(report):
            self._told.clear()
            found += self.part(now)
        found += [*self._look_at_motion(report, now), *self._look_at_facts(report, now)]
        found += [*self._look_at_place(report, now), *self._look_at_homing(report, now)]
        self._last, self._last_at = report, now
        return found

    def _has_booted(self, report: Report) -> bool:
        before = None if self._last is None else self._last.boot_id
        return before is not None and report.boot_id not in (None, before)

    def _look_at_commands(self, report: Report, now: float) -> Iterator[Difference]:
        for sign in SIGNS:
            id = getattr(report, sign)
            is_news = id is not None and self._signs.get(sign) != id
            told = self._told.get(id) if is_news else None
            if told is not None:
                yield from self._first_sign(told, sign, now)
                yield from self._end(told, sign, report, now)
            if is_news:
                self._signs[sign] = id
        for told in [*self._told.values()] if "accepted" in self._signs else ():
            is_open = told.heard_at is None and not (told.is_over or isinstance(told.command, Stop))
            if is_open and now - told.at > UNANSWERED_S:
                told.heard_at, told.is_timed = now, False
                yield self._spans.found("unanswered", told.at)

    def _first_sign(self, told: _Told, sign: str, now: float) -> Iterator[Difference]:
        if told.heard_at is not None:
            return
        if sign in ("accepted", "rejected"):
            if now - told.at > PROMPT_S:
                yield self._spans.found("confirmed_late", now, amount=now - told.at)
        elif "accepted" in self._signs:
            yield self._spans.found("done_unconfirmed", now)
        for each in self._told.values():  # those before it are overtaken: only the last one is told
            each.heard_at = each.heard_at or now
            if each is told:
                break

    def _end(self, told: _Told, sign: str, report: Report, now: float) -> Iterator[Difference]:
        command = told.command
        if sign == "accepted":
            if isinstance(command, Stop):
                del self._told[command.id]
            return
        del self._told[command.id]
        self._ended_at = now
        self._facts.end(command, now)
        if sign == "rejected" and report.refusal not in Board.words:
            yield self._spans.found("refused", now, word=report.refusal or "")
        elif sign == "failed" and report.failure not in Board.words:
            yield self._spans.found("gave_up", now, word=report.failure or "")
        elif sign in ("done", "answered"):
            yield from self._duration(told, now)
        if sign == "done":
            yield from self._look_at_end(command, report, now)

    def _duration(self, told: _Told, now: float) -> Iterator[Difference]:
        """Work that took longer than a virtual device takes, or less."""
        expected_s = self._expected_s(told)
        if expected_s is None or not told.is_timed or told.heard_at is None:
            return
        slack_s = PROMPT_S + SHARE * expected_s
        if (longer_s := now - told.heard_at - expected_s) > slack_s:
            yield self._spans.found("takes_longer", now, amount=longer_s)
        elif (less_s := expected_s - (now - told.at)) > slack_s and self._robot.floor_grid is None:
            yield self._spans.found("takes_less", now, amount=less_s)

    def _expected_s(self, told: _Told) -> float | None:
        command, robot = told.command, self._robot
        if isinstance(command, VerbCommand):
            with suppress(UseError):
                return command.takes_s
        if isinstance(command, MoveJoints) and robot.joints and isinstance(told.start, tuple):
            return robot.motion.travel_s(told.start, command.way) / robot.pace
        if isinstance(command, FollowPath) and robot.floor_grid is not None:
            return robot.motion.travel_s(None, command.way) / robot.pace
        return None

    def _look_at_end(self, command: Command, report: Report, now: float) -> Iterator[Difference]:
        """Differences in the report that has the end of a command."""
        if isinstance(command, Motion) and report.state is MotionState.MOVING and not self._works:
            yield self._spans.found("done_moving", now)
        self._facts.compare(command, report)
        if isinstance(command, MoveJoints) and self._robot.joints and report.q is not None:
            if not self._robot.motion.stands_at(report.q, command.q):
                yield self._spans.found("done_elsewhere", now, **self._farthest(report.q, command.q))
        elif isinstance(command, FollowPath) and report.node not in (None, command.nodes[-1]):
            yield self._spans.found("done_elsewhere", now, word="nodo")

    def _farthest(self, q: tuple[float, ...], goal: tuple[float, ...]) -> dict[str, Any]:
        """The joint that is farthest off, as telemetry names it, and by how many tolerances."""
        motion: Any = self._robot.motion  # that of joints
        rows = enumerate(zip(q, goal, motion.tolerances, strict=True), start=1)
        off, number = max((abs(here - there) / within, number) for number, (here, there, within) in rows)
        return {"word": f"q{number}_mov", "amount": off}

    def _look_at_motion(self, report: Report, now: float) -> Iterator[Difference]:
        moves = report.state is MotionState.MOVING
        stop_at = self._stop_at
        self._has_moved = self._has_moved or moves
        if not moves and stop_at is not None and (self._has_moved or now - stop_at > PROMPT_S):
            if self._has_moved and now - stop_at > PROMPT_S + self._ramp_s:
                yield self._spans.found("stopped_late", stop_at, amount=now - stop_at)
            self._end_works()
            self._stop_at, self._has_moved, self._is_halted = None, False, True
        self._has_stood = self._has_stood or not moves
        just_ended = now - self._ended_at <= PROMPT_S + self._ramp_s
        strays = moves and self._has_stood and not (self._works or just_ended or now < self._excused_until)
        after_stop, since_s = strays and self._is_halted, now - self._stopped_at
        yield from self._spans.look("begins_after_stop", "", now, goes_on=after_stop, amount=since_s)
        yield from self._spans.look("moves_by_itself", "", now, goes_on=strays and not after_stop)

    def _look_at_facts(self, report: Report, now: float) -> Iterator[Difference]:
        is_excused = now < self._excused_until
        under_way = None if is_excused else self._under_way
        last = None if self._last is None else self._last.facts
        yield from self._facts.look(report, last, under_way, now)

    def _look_at_homing(self, report: Report, now: float) -> Iterator[Difference]:
        homes = any(isinstance(each, Home) for each in self._under_way)
        was = self._last is not None and self._last.homed is True
        is_lost = was and report.homed is False and not (homes or now < self._excused_until)
        goes_on = is_lost or ("" in self._spans.words("unhomed") and report.homed is not True)
        yield from self._spans.look("unhomed", "", now, goes_on=goes_on)

    def _look_at_place(self, report: Report, now: float) -> Iterator[Difference]:
        motion: Any = self._robot.motion  # that of joints
        last = self._last
        if not self._robot.joints or report.q is None:
            return
        beyond = motion.beyond(report.q) is not None
        yield from self._spans.look("beyond", "", now, goes_on=beyond)
        homes = any(isinstance(each, Home) for each in self._under_way)
        if last is None or last.q is None or homes or now < self._excused_until:
            return
        within_s = now - self._last_at + PROMPT_S
        if now - self._ended_at > PROMPT_S and not motion.can_have_moved(last.q, report.q, within_s):
            yield self._spans.found("jumped", now, **self._farthest(report.q, last.q))


def _place(report: Report) -> object:
    return report.q if report.q is not None else report.node


def _ramp_s(robot: Any) -> float:
    """The time in which a virtual device comes to rest, s."""
    if robot.floor_grid is not None:
        return float(robot.floor_grid.pitch / robot.speed)
    return max((joint.speed / joint.acceleration for joint in robot.joints), default=0.0)
