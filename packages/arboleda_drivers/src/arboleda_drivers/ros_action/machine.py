"""State machine for one device behind an action server: its goal, its stops, and its measurements."""

from __future__ import annotations

import math
from collections.abc import Sequence

from arboleda.drivers import Command, Home, MotionState, Report, Stop, StopMode, lost, plain
from arboleda_drivers.connections.link import CommandNotSent, CommandRequest
from arboleda_drivers.connections.receipts import Receipts

from .asks import ANSWER_S, Asks
from .events import (
    CancelAll,
    CancelAnswer,
    Event,
    GoalAnswer,
    GoalList,
    GoalResult,
    Measurement,
    Message,
    SendGoal,
    ServersFound,
    Status,
    UnusableMessage,
)
from .goal import SETTLE_S, Goal
from .goal_history import GoalHistory
from .health import CallAnswer, Health, HealthReading, HealthWatch
from .homing import LONGEST_WORD, Homing
from .mover import Mover, NoGoal
from .presence import GONE_S, End, Presence

SPARE_S = 0.5  # the plant's own deadline comes first
REPORT_S = 0.1  # a report at least so often


class Machine:
    """State machine of one device behind one action; `step` takes events and returns actions and reports."""

    def __init__(self, mover: Mover, action: str, health: Health | None = None) -> None:
        self._mover, self._end_of = mover, End("action", action)
        self._health = HealthWatch(health)
        self._history = GoalHistory(mover.name)
        self._out: list[Message] = []
        self._receipts = Receipts()
        self._homing = Homing(self._health, self._out, self._receipts)
        self._presence = Presence([self._end_of])
        self._asks = Asks({self._end_of: CancelAll()}, self._out, self._receipts)
        self._why = ""  # the reported reason for a missing link
        self._goal: Goal | None = None
        self._latched = False
        self._measured_at = math.inf  # time of the first measurement

    def step(self, now: float, events: Sequence[Event]) -> list[Message]:
        """Take events and the time, and return the messages to act on; at most one of them is a report."""
        for event in events:
            self._take(now, event)
        why = self._missing(now)
        if why:
            self._lose(now, why)
        else:
            self._pass_time(now)
            due = self._receipts.is_due(now, REPORT_S)
            if due and now >= self._measured_at + SETTLE_S:  # before, nobody knows whether the device rests
                self._out.append(self._receipts.on(now, self._report(now)))
        out = self._out.copy()
        self._out.clear()
        return out

    def _take(self, now: float, event: Event) -> None:
        if isinstance(event, CommandRequest):
            self._ask(now, event.command)
        elif isinstance(event, ServersFound):
            if self._presence.find(now, {self._end_of: event.servers}):
                self._forget()
        elif isinstance(event, Measurement):
            self._see(now, event)
        elif isinstance(event, GoalAnswer):
            self._hear_answer(now, event)
        elif isinstance(event, GoalResult):
            self._hear_end(now, event)
        elif isinstance(event, GoalList):
            self._history.list(event.goals)
        elif isinstance(event, HealthReading):
            self._see_health(now, event)
        elif isinstance(event, CallAnswer):
            self._homing.hear(now, event)
        elif isinstance(event, UnusableMessage):
            self._lose(now, event.why)
        else:
            self._hear_cancel(now, event)

    def _pass_time(self, now: float) -> None:
        goal = self._goal
        self._asks.pass_time(now)
        self._homing.pass_time(now)
        if goal is None:
            return
        if not goal.accepted and not goal.stopped and now >= goal.sent_at + ANSWER_S:
            # It may still be accepted later, and is cancelled then.
            self._drop(failed=goal.id, failure="goal_not_answered")
            self._cancel(now)
        elif not goal.stopped and now >= goal.over_at:
            # No step of a task waits for it any more, and nobody halts a switch.
            self._drop(failed=goal.id, failure="not_ended")
            self._cancel(now)
        elif goal.unknown_at is not None and now >= goal.unknown_at + GONE_S:
            self._drop(failed=goal.id, failure="goal_unknown_to_the_server")
        elif goal.succeeded_at is not None:
            self._believe(now, goal, goal.succeeded_at)
        elif goal.stopped:
            # The server has cancelled all it has, and the device rests: no result is waited for.
            cancelled_s = self._asks.answered_for_s(now, self._end_of)
            if cancelled_s >= ANSWER_S and self._mover.rests(now, now - cancelled_s):
                self._drop()

    def _believe(self, now: float, goal: Goal, since: float) -> None:
        """Accept a result once a later measurement shows the goal, or rest elsewhere.

        The plant compares positions and facts in any case, and says that the goal was not reached.
        """
        if not self._mover.has_measured_since(since):
            return
        there = self._mover.is_at(goal.what)
        if not there and not self._mover.rests(now, since):
            return
        if not there:
            self._cancel(now)  # a server that reported a wrong end may still carry it out
        objection = self._mover.objection(goal.what)
        self._mover.settle(goal.what)
        if objection:
            self._end(failed=goal.id, failure=objection)
        elif there and goal.advance(now):
            self._send(goal)
        else:
            self._history.end()
            self._end(done=goal.id)

    # The link.

    def _missing(self, now: float) -> str:
        """The reason why the device cannot be reached; "" if it can."""
        return self._presence.missing(now) or self._mover.missing(now) or self._health.missing

    def _lose(self, now: float, why: str) -> None:
        """Lose the link, and open work; a goal that still runs is cancelled once the server is back."""
        if self._goal is not None:
            self._goal.stopped, self._goal.succeeded_at = True, None
        self._asks.leave([] if self._goal is None else [self._end_of])
        self._homing.id = ""
        if why != self._why:
            self._why = why
            self._out.append(lost(self._mover.name, at=now, why=why))

    def _forget(self) -> None:
        """The server was started anew, and knows of no goal."""
        self._goal, self._homing.id = None, ""
        self._history.forget()
        self._asks.leave(())
        self._asks.forget(self._end_of)
        self._receipts.forget()
        self._mover.settle(None)

    def _see(self, now: float, measurement: Measurement) -> None:
        if not self._mover.see(now, measurement):
            return
        self._measured_at = min(self._measured_at, now)
        self._homing.see()

    # Its health.

    def _see_health(self, now: float, reading: HealthReading) -> None:
        if not self._health.see(reading.value):
            return
        self._receipts.news = True
        if self._goal is not None and not self._health.is_well:
            self._drop(failed=self._goal.id, failure=self._health.word)
            self._cancel(now)

    # Commands.

    def _ask(self, now: float, command: Command) -> None:
        why = self._missing(now)
        if why:
            self._out.append(CommandNotSent(why=why))
        elif isinstance(command, Stop):
            self._ask_stop(now, command)
        elif self._homing.id or (self._goal is not None and not self._mover.replaces):
            self._receipts.reject(command.id, "busy")
        elif isinstance(command, Home):
            self._homing.begin(now, command.id)
        elif not self._health.is_well:
            self._receipts.reject(command.id, self._health.word)
        else:
            self._begin(now, command)

    def _begin(self, now: float, command: Command) -> None:
        try:
            parts = self._mover.goals(command)
        except NoGoal as error:
            self._out.append(CommandNotSent(why=str(error)))
            return
        if self._goal is not None:
            self._drop(failed=self._goal.id, failure="replaced_by_the_next")
        over_at = math.inf if command.at_most_s is None else now + command.at_most_s + SPARE_S
        self._goal = Goal(id=command.id, parts=parts, sent_at=now, over_at=over_at)
        self._history.begin(command)
        self._send(self._goal)

    def _send(self, goal: Goal) -> None:
        self._out.append(SendGoal(id=goal.key, uuid=self._history.send(goal), goal=goal.what))
        self._receipts.news = True

    def _ask_stop(self, now: float, command: Stop) -> None:
        if command.mode is not StopMode.HALT:
            self._latched = command.mode is StopMode.LATCH
        self._receipts.news = True
        if command.mode is StopMode.CLEAR:
            self._asks.clear(now, command.id)
            return
        self._homing.id = ""
        if self._goal is not None:
            self._goal.stopped, self._goal.succeeded_at = True, None
        self._asks.stop(now, command.id)

    def _cancel(self, now: float) -> None:
        self._asks.begin(now, self._end_of)

    # Answers of the server.

    def _hear_answer(self, now: float, answer: GoalAnswer) -> None:
        self._history.answer(answer.id, accepted=answer.accepted)
        if self._asks.hear_goal(now, self._end_of, self._goal, answer):
            self._end()

    def _hear_end(self, now: float, end: GoalResult) -> None:
        goal = self._goal
        if goal is None or end.id != goal.key:
            return
        failure = self._mover.failure(end, goal.what)
        if goal.stopped:
            self._drop()
        elif end.status is Status.UNKNOWN:
            goal.unknown_at = now  # most likely it was started anew, which is seen only at the next look
        elif failure:
            self._drop(failed=goal.id, failure=failure)
        else:
            goal.succeeded_at = now

    def _hear_cancel(self, now: float, answer: CancelAnswer) -> None:
        if not self._asks.is_open(self._end_of):
            return
        is_refused = answer.refused and self._goal is not None
        if not is_refused:
            self._history.leave_behind()
        self._asks.answer(now, self._end_of, "cancel_refused" if is_refused else "")

    # What the plant hears.

    def _drop(self, **ids: str) -> None:
        """End a goal without knowing how far it has led."""
        self._mover.settle(None)
        self._end(**ids)

    def _end(self, *, failure: str = "", **ids: str) -> None:
        self._goal = None
        self._receipts.tell(**ids, failure=plain(failure, LONGEST_WORD))

    def _state(self, now: float) -> MotionState:
        at_work = self._goal is not None or self._asks.is_stopping
        # A device that waits at an obstacle rests, and goes on by itself; a grip may never end.
        goes_on = self._history.has_earlier_goal and not self._mover.replaces
        if at_work or goes_on or not self._mover.rests(now):
            return MotionState.MOVING
        if self._latched:
            return MotionState.STOP_LATCHED
        if not self._health.is_well:
            return MotionState.FAULT if not self._homing.id else MotionState.NOT_HOMED
        return MotionState.STOPPED

    def _report(self, now: float) -> Report:
        self._why = ""
        return Report(
            at=now,
            robot=self._mover.name,
            boot_id=self._presence.boot,
            state=self._state(now),
            homed=not self._homing.id,
            receipt=self._history.receipt,
            tokens=self._history.tokens,
            **self._mover.shows(busy=self._goal is not None) | self._health.shows,
        )
