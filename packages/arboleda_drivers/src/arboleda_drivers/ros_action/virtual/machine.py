"""Virtual action server: goals, their ends, cancels, and measurements. No ROS 2, no clock."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from arboleda_drivers.ros_action.events import GoalAnswer, GoalResult, Measurement, Status

from .ride import Position, Ride

LATE_ANSWER_S, LATE_RESULT_S = 3.0, 1.0
SHORT = 0.9
SLOW = 10.0
MEASURE_S = 0.02


@dataclass(frozen=True, kw_only=True)
class GoalRequest:
    """Event: a client sends a goal; its content is the body's own."""

    id: str
    goal: Any


@dataclass(frozen=True, kw_only=True)
class CancelRequest:
    """Event: a client wants a goal to end."""

    id: str


@dataclass(frozen=True, kw_only=True)
class CancelDecision:
    """Answer to a cancel request."""

    id: str
    accepted: bool


Message = GoalAnswer | GoalResult | Measurement | CancelDecision


class BadGoal(Exception):
    """Error: the server refuses a goal."""


class Body(Protocol):
    """Device that the server moves."""

    position: Position
    preempted: Status  # end of a goal that another one replaces

    def ride(self, now: float, goal: Any, slower: float) -> Ride:
        """The ride to a goal; raises BadGoal if there is none."""

    def moved(self, now: float, position: Position) -> bool:
        """Move to a position; False if it cannot be reached, which ends the goal."""

    def rests(self, now: float) -> None:
        """Called while there is no goal."""

    def end(self, id: str, ride: Ride, *, arrived: bool) -> GoalResult:
        """The end of a goal by itself."""

    def aborted(self, id: str) -> GoalResult:
        """The end of a goal that goes wrong half way."""

    def measured(self, stamp: tuple[int, int], position: Position) -> list[Measurement]:
        """The measurements of its sensors."""


class VirtualServer:
    """Virtual server of one action; `faults` are looked up when they matter. Times in s of any clock."""

    def __init__(self, body: Body, faults: Collection[str] = (), *, measure_s: float = MEASURE_S) -> None:
        self.body, self.faults = body, faults
        self._measure_s = measure_s
        self._goal: str | None = None
        self._ride: Ride | None = None
        self._late: list[tuple[float, Message]] = []
        self._measure_at = -math.inf
        self._measured: tuple[tuple[int, int], Position] | None = None  # the last measurement
        self._off = False

    @property
    def is_off(self) -> bool:
        """True while there is no server."""
        return "vanish" in self.faults

    @property
    def is_doubled(self) -> bool:
        return "double" in self.faults

    @property
    def next_deadline(self) -> float:
        ends = (self._ride.middle_at, self._ride.ends_at) if self._ride is not None else ()
        ahead = [each for each in ends if each > self._measure_at - self._measure_s]
        return min([self._measure_at, *ahead, *(at for at, _ in self._late)])

    def step(self, now: float, events: Sequence[GoalRequest | CancelRequest]) -> list[Message]:
        """Let time pass, take requests, and return messages."""
        if self.is_off or self._off:
            self._boot()
            self._off = self.is_off
            if self._off:
                self._measure_at = now + self._measure_s
                return []
        out = self._pass_time(now)
        for event in events:
            out += self._begin(now, event) if isinstance(event, GoalRequest) else self._cancel(event)
        out += [message for at, message in self._late if at <= now]
        self._late = [row for row in self._late if row[0] > now]
        if self._measure_at <= now:
            self._measure_at = now + self._measure_s
            out += self._measure(now)
        return out

    def _boot(self) -> None:
        self._goal = self._ride = None
        self._late.clear()

    # Motion.

    def _pass_time(self, now: float) -> list[Message]:
        ride = self._ride
        if ride is None:
            self.body.rests(now)
            return []
        out = self._befall() if now >= ride.middle_at else []
        if self._ride is None:
            return out
        arrived = self.body.moved(now, ride.at(now))
        if arrived and now < ride.ends_at:
            return out
        self._ride = None
        return out + self._over(now, self.body.end(self._goal or "", ride, arrived=arrived))

    def _befall(self) -> list[Message]:
        """Let the present fault strike the goal half way."""
        if "stall" in self.faults:
            self._ride = None
        elif "abort" in self.faults:
            return self._stand(self.body.aborted)
        elif "other_client" in self.faults:
            return self._stand(lambda id: GoalResult(id=id, status=self.body.preempted))
        return []

    def _stand(self, end: Callable[[str], GoalResult]) -> list[Message]:
        self._ride = None
        id, self._goal = self._goal, None
        return [] if id is None else [end(id)]

    def _over(self, now: float, end: GoalResult) -> list[Message]:
        if self._goal is None or "no_result" in self.faults:
            return []  # it goes on although it ended, or its end is not reported
        self._goal = None
        if "late_result" in self.faults:
            self._late.append((now + LATE_RESULT_S, end))
            return []
        return [end]

    # What clients ask.

    def _begin(self, now: float, request: GoalRequest) -> list[Message]:
        try:
            if "refuse" in self.faults:
                raise BadGoal("refused")
            ride = self.body.ride(now, request.goal, SLOW if "slow" in self.faults else 1.0)
        except BadGoal:
            return [GoalAnswer(id=request.id, accepted=False)]
        out = self._stand(lambda id: GoalResult(id=id, status=self.body.preempted))
        answer = GoalAnswer(id=request.id, accepted=True)
        if "late_answer" in self.faults:
            self._late.append((now + LATE_ANSWER_S, answer))
        else:
            out.append(answer)
        self._goal, self._ride = request.id, ride.cut(SHORT) if "short" in self.faults else ride
        if "lie" in self.faults or "early" in self.faults:
            out.append(GoalResult(id=request.id, status=Status.SUCCEEDED))
            self._goal = None
            self._ride = None if "lie" in self.faults else ride
        return out

    def _cancel(self, request: CancelRequest) -> list[Message]:
        if request.id != self._goal or "refuse_cancel" in self.faults:
            return [CancelDecision(id=request.id, accepted=False)]
        decided = CancelDecision(id=request.id, accepted=True)
        if "deaf" in self.faults:
            return [decided]
        self._ride = self._goal = None
        return [decided, GoalResult(id=request.id, status=Status.CANCELED)]

    # What it measures.

    def _measure(self, now: float) -> list[Message]:
        if "mute" in self.faults:
            return []
        stamp = (int(now), int(now % 1 * 1e9))
        if self._measured is None or not {"frozen", "stuck"} & set(self.faults):
            self._measured = (stamp, self.body.position)
        elif "stuck" in self.faults:
            self._measured = (stamp, self._measured[1])
        position = self._measured[1]
        if "no_number" in self.faults:
            position = (math.nan,) * len(position)
        return list(self.body.measured(self._measured[0], position))
