"""Goals that the servos of joints are given: for a move, to hold, and to be made ready."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from arboleda.drivers import Jointed

from .bus import Bus
from .position_watch import Plan, PositionWatch
from .servos import MAKERS, TICKS, Goal, Reading, reboot
from .settings import Settings
from .work import Picture

HOLD_RAMP_S = 0.1  # the ramp of a hold
FAR_TICKS = 100  # 9 degrees, which a servo goes in a round of questions by a good line
LEAST_TICKS_S = 1.0  # speed of a servo that holds without a position: no servo takes 0 for standing


class JointGoals:
    """Goals of one connection."""

    def __init__(self, robot: Jointed, settings: Settings, bus: Bus) -> None:
        self.watch = PositionWatch()
        self._robot, self._settings, self._bus = robot, settings, bus
        self._maker = MAKERS[settings.protocol]
        self._ids = [servo.id for servo in settings.joints]
        self._speeds: Mapping[int, float] = {}  # of the last move, ticks/s
        self._unheard: dict[int, float] = {}  # servos that are to tell where they hold, and since when

    @property
    def are_unheard(self) -> bool:
        """True while a servo is to tell where it is, so that it can hold there."""
        return bool(self._unheard)

    def move(self, now: float, goals: Mapping[int, int], picture: Picture) -> None:
        """Write goals with speeds by which all joints arrive together, at the share of the model's speed."""
        share = self._settings.model_speed_share
        rows = list(zip(self._ids, self._robot.joints, strict=True))
        ways = {id: abs(goals[id] - picture.readings[id].position) for id in self._ids}
        time_s = max(ways[id] / (per_s(joint.speed) * share) for id, joint in rows)
        ramp_s = max(joint.speed * share / joint.acceleration for _, joint in rows)
        self._unheard.clear()
        self._speeds = speeds = {id: ways[id] / time_s if time_s > 0 else 1.0 for id in self._ids}
        begins_at = now + ramp_s / 2  # as if it had all of its speed at once
        ends_at = begins_at + time_s
        self.watch.begin(Plan(told_at=now, goals=goals, speeds=speeds, begins_at=begins_at, ends_at=ends_at))
        self._write(
            {
                id: Goal(position=goals[id], speed=speed, acceleration=speed / ramp_s)
                for id, speed in speeds.items()
            }
        )

    def hold(self, now: float, goals: Mapping[int, int]) -> dict[int, int]:
        """Write and return goals by which joints hold, before anything else; `goals` are those of a move."""
        held = self.held(now, goals)
        self.watch.end()
        self._bus.writes.clear()
        if held:
            self._write(held)
        return {id: goal.position for id, goal in held.items()}

    def held(self, now: float, goals: Mapping[int, int]) -> dict[int, Goal]:
        """The goals by which servos hold; a servo without torque has none.

        Each holds at its position, to which it goes at the speed of the move. A servo whose position is older
        than a round, or that has gone on far since, would go back a long way: it keeps its goal, at the least
        speed that it has, until it tells where it is.
        """
        held = {}
        for id, reading in self._bus.latest.items():
            if id not in self._ids or not reading.torque:
                continue
            is_heard, is_old = self._is_heard(now, id, reading), self.watch.is_old(id)
            if is_heard:
                self._unheard.pop(id, None)
            else:
                self._unheard.setdefault(id, now)
            if is_heard and not is_old:
                held[id] = self._goal(reading.position, self._speeds.get(id, self._usual_ticks_s))
            else:
                if is_old:
                    self.watch.unknown.add(id)
                held[id] = self._goal(goals.get(id, reading.goal), LEAST_TICKS_S)
        return held

    def make_ready(self, ids: Sequence[int], picture: Picture) -> None:
        """Have servos hold where they are; one with an alarm boots first, where that ends its alarm."""
        if alarmed := [id for id in ids if picture.readings[id].alarms and self._maker.reboots]:
            self._bus.writes.extend(reboot(self._maker, id) for id in alarmed)
        if ready := [id for id in ids if id not in alarmed]:
            # Its goal first: with the one of before it would jump there.
            rows = {id: picture.readings[id].position for id in ready}
            slow = {id: LEAST_TICKS_S if id in picture.stuck else self._usual_ticks_s for id in ready}
            self._write({id: self._goal(at, slow[id]) for id, at in rows.items()})
            self.watch.excuse(ready)
            self._bus.writes.append(self._maker.torque(ready, on=True))

    def _is_heard(self, now: float, id: int, reading: Reading) -> bool:
        """True if a servo can hold where it was read: lately, and not before it was told to wait for that."""
        quick = per_s(max(joint.speed for joint in self._robot.joints)) * self._settings.model_speed_share
        is_near = self.watch.gone(id, reading.at, now, at_most_s=quick) <= FAR_TICKS
        is_lately = reading.at >= self._bus.last_round_at
        return is_near and is_lately and reading.at > self._unheard.get(id, -math.inf)

    def _write(self, goals: Mapping[int, Goal]) -> None:
        self._bus.writes.append(self._maker.goals(goals))

    def _goal(self, position: int, speed: float) -> Goal:
        least, most = self._maker.positions
        quick = per_s(max(joint.speed for joint in self._robot.joints)) / HOLD_RAMP_S
        return Goal(position=min(max(position, least), most), speed=speed, acceleration=quick)

    @property
    def _usual_ticks_s(self) -> float:
        """The speed of a joint where no move of this connection has told another one."""
        return per_s(min(joint.speed for joint in self._robot.joints)) * self._settings.model_speed_share


def per_s(speed: float) -> float:
    """The speed in ticks/s of one in rad/s."""
    return speed * TICKS / math.tau
