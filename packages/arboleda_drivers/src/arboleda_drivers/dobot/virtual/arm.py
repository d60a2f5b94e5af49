"""Arm of a virtual Dobot: its power, alarms, queue of moves, and what befalls it."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Collection
from dataclasses import dataclass

from arboleda_drivers.dobot.frames import Mode
from arboleda_drivers.virtual.joint_path import Drive, Joints, Path, between

SPEED_DEG_S = (150.0, 150.0, 180.0, 223.0, 223.0, 223.0)  # of a CR10A, as its maker publishes them
ACCELERATION_DEG_S2 = 180.0
ENABLE_S, POWER_S = 0.5, 1.0  # a real one takes some 10 s to be powered
LATE_START_S = 0.2
SHORT_DEG = 2.0
BUTTON, NO_SOLUTION = 116, 17  # alarms


@dataclass(frozen=True, kw_only=True)
class QueuedMove:
    """Move that waits for its turn."""

    number: int
    goal: Joints
    speed_percent: float = 100.0
    acceleration_percent: float = 100.0


class Arm:
    """Arm with its queue; `outputs` are those of the tool, a bit each."""

    def __init__(self, faults: Collection[str], *, joints_deg: Joints, enabled: bool) -> None:
        self.drive = Drive(joints_deg, faults)
        self.outputs = 0
        self.speed_percent = 100.0
        self.is_powered = True
        self._faults = faults
        self._enabled_at = -math.inf if enabled else math.inf
        self._powered_at = math.inf
        self._now = -math.inf
        self._forget()

    def _forget(self) -> None:
        self.drive.path = None
        self.queue: deque[QueuedMove] = deque()
        self.command = 0  # the number of the last move that began
        self.last_number = 0
        self.alarms: set[int] = set()
        self.has_collided = self.is_paused = self.is_enabled = False

    def boot(self) -> None:
        self._forget()
        self._enabled_at, self.outputs = math.inf, 0

    @property
    def mode(self) -> Mode:
        if self.alarms:
            return Mode.ERROR
        if self.has_collided:
            return Mode.COLLISION
        if not self.is_powered:
            return Mode.POWER_OFF
        if not self.is_enabled:
            return Mode.DISABLED
        if self.is_paused:
            return Mode.PAUSED
        path = self.drive.path
        moves = path.began_at <= self._now if path is not None else bool(self.queue)
        return Mode.RUNNING if moves or "script" in self._faults else Mode.IDLE

    def pass_time(self, now: float) -> None:
        self._now = now
        self.is_powered = self.is_powered or self._powered_at <= now
        self.befall(now)
        self.is_enabled = self._enabled_at <= now
        self.drive.travel(now)
        while self.drive.path is None and self.queue and self.mode is Mode.RUNNING:
            self._begin(now, self.queue.popleft())
            self.drive.travel(now)

    def befall(self, now: float) -> None:
        """Let the faults strike that befall an arm by themselves."""
        if "power_off" in self._faults:
            self.is_powered, self._powered_at = False, math.inf
            self.halt(now, disable=True)
        if "stop_button" in self._faults:
            self.press_button(now)
        if not self.drive.is_half_way(now):
            return
        if "collision" in self._faults:
            self.has_collided = True
            self.halt(now)
        if "alarm" in self._faults:
            self.alarms.add(NO_SOLUTION)
            self.halt(now)
        if "second_client" in self._faults:
            self.drive.path = None
            goal = tuple(each + 5 for each in self.drive.joints)
            self._begin(now, QueuedMove(number=self.next_number(), goal=goal))

    def next_number(self) -> int:
        self.last_number += 1
        return self.last_number

    def _begin(self, now: float, queued: QueuedMove) -> None:
        self.command = queued.number
        if "lie" in self._faults:
            return
        goal, joints = queued.goal, self.drive.joints
        if "short" in self._faults:
            goal = (goal[0] - math.copysign(SHORT_DEG, goal[0] - joints[0]), *goal[1:])
        speed = queued.speed_percent * self.speed_percent / 100 * (0.1 if "slow" in self._faults else 1.0)
        begins_at = now + LATE_START_S if "late_start" in self._faults else now
        self.drive.path = _path(joints, goal, begins_at, speed, queued.acceleration_percent)

    def halt(self, now: float, *, disable: bool = False) -> None:
        self.queue.clear()
        self.is_paused = False
        self.drive.brake(now)
        if disable:
            self._enabled_at = math.inf

    def press_button(self, now: float) -> None:
        self.alarms.add(BUTTON)
        self.halt(now, disable=True)

    def power(self, now: float) -> None:
        if not self.is_powered and "power_off" not in self._faults:
            self._powered_at = now + POWER_S

    def enable(self, now: float) -> None:
        if not self.is_enabled:
            self._enabled_at = now + ENABLE_S


def _path(start: Joints, goal: Joints, now: float, speed_percent: float, acceleration_percent: float) -> Path:
    """The path of a joint move that begins now."""
    distances = [abs(b - a) for a, b in zip(start, goal, strict=True)]
    times = [distance / speed for distance, speed in zip(distances, SPEED_DEG_S, strict=True)]
    slowest = times.index(max(times))
    return between(
        start,
        goal,
        now,
        speed=SPEED_DEG_S[slowest] * speed_percent / 100,
        acceleration=ACCELERATION_DEG_S2 * acceleration_percent / 100,
        leading=slowest,
    )
