"""Troubles of the devices of a recorded plant, seen in their reports: silences, boots, alarms."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace

from arboleda.drivers import MotionState, Report

SILENT_S = 0.6  # boards report ten times a second, so such a silence means lost messages
ROUNDING_S = 1e-6
SILENCE, BOOT, ALARM, BRIDGE = "silence", "boot", "alarm", "bridge"


@dataclass(frozen=True, kw_only=True)
class Trouble:
    """Trouble of a robot, from `at` on for `seconds` of the plant's clock; inf: to the end.

    `lost_at`: the time at which its link was reported as lost, None if it was not. `cut`: the report came
    sooner than a silence would cause one, so the connection broke.
    """

    kind: str
    robot: str
    at: float
    seconds: float = 0.0
    lost_at: float | None = None
    cut: bool = False

    @property
    def ends(self) -> float:
        return self.at + self.seconds


@dataclass
class _RobotState:
    """Last report of a robot."""

    at: float
    report: Report
    lost_at: float | None = None
    alarm_at: float | None = None


@dataclass
class Troubles:
    """Reads reports in their order. `supervised` are the robots whose silence means something: after
    `stale_after_s` their link counts as lost."""

    supervised: frozenset[str]
    stale_after_s: float
    found: list[Trouble] = field(default_factory=list)
    _robots: dict[str, _RobotState] = field(default_factory=dict)

    def take(self, events: Iterable[object]) -> None:
        for event in events:
            if isinstance(event, Report) and event.robot in self.supervised:
                self._hear(event)

    def of(self, now: float) -> list[Trouble]:
        """All troubles in order, including those still open at `now`."""
        return sorted([*self.found, *self._open(now)], key=lambda each: each.at)

    def _hear(self, report: Report) -> None:
        known = self._robots.get(report.robot)
        if report.state is None:
            return
        if report.state is MotionState.NO_LINK:
            if known is not None and known.lost_at is None:
                known.lost_at = report.at
            return
        if known is None:
            self._robots[report.robot] = known = _RobotState(report.at, report)
        else:
            self.found += _between(known.report, report, self._silence(known, report.at))
        self._mind_alarm(known, report)
        known.at, known.report, known.lost_at = report.at, report, None

    def _mind_alarm(self, known: _RobotState, report: Report) -> None:
        if report.state is MotionState.FAULT:
            known.alarm_at = report.at if known.alarm_at is None else known.alarm_at
        elif known.alarm_at is not None:
            began, known.alarm_at = known.alarm_at, None
            self.found.append(Trouble(kind=ALARM, robot=report.robot, at=began, seconds=report.at - began))

    def _open(self, now: float) -> Iterator[Trouble]:
        for robot, known in self._robots.items():
            if known.alarm_at is not None:
                yield Trouble(kind=ALARM, robot=robot, at=known.alarm_at, seconds=math.inf)
            if known.lost_at is not None or now - known.at > SILENT_S:
                yield self._silence(known, math.inf)

    def _silence(self, known: _RobotState, until: float) -> Trouble:
        at, lost_at = known.at, known.lost_at
        cut = lost_at is not None and lost_at - at < self.stale_after_s - ROUNDING_S
        robot = known.report.robot
        return Trouble(kind=SILENCE, robot=robot, at=at, seconds=until - at, lost_at=lost_at, cut=cut)


def _between(before: Report, report: Report, silence: Trouble) -> Iterator[Trouble]:
    """The trouble that two consecutive reports prove, if any: a new bridge, a boot, or a silence."""
    if None not in (report.epoch, before.epoch) and report.epoch != before.epoch:
        yield replace(silence, kind=BRIDGE)
    elif None not in (report.boot_id, before.boot_id) and report.boot_id != before.boot_id:
        yield replace(silence, kind=BOOT)
    elif silence.lost_at is not None or silence.seconds > SILENT_S:
        yield silence
