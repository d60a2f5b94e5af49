"""State machine of the driver `ros`: goals, requests and messages of one device become reports.

An end counts by its goal's id or its own response. It is told once topics show the facts that the verb sets,
or have had the time for it; the plant compares them in any case. What was stopped, given up or lost counts as
at work until its server says that it has ended, and a goal that is accepted late is cancelled then.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from arboleda.drivers import (
    Device,
    DriverError,
    Effect,
    MotionState,
    Report,
    Robot,
    Stop,
    StopMode,
    VerbCommand,
    Work,
    lost,
    plain,
)
from arboleda_drivers.connections.link import CommandNotSent
from arboleda_drivers.connections.receipts import Receipts
from arboleda_drivers.paths import field_at
from arboleda_drivers.plc.plc_snapshot import STATES
from arboleda_drivers.ros_action.asks import CLEAR, STOP, Asks
from arboleda_drivers.ros_action.events import CancelAnswer, GoalAnswer, GoalList, GoalResult, Said, Status
from arboleda_drivers.ros_action.goal import SETTLE_S
from arboleda_drivers.ros_action.goal_history import GoalHistory
from arboleda_drivers.ros_action.homing import LONGEST_WORD
from arboleda_drivers.ros_action.presence import GONE_S, End, Presence

from .events import (
    ActionSaid,
    CancelGoals,
    EndsFound,
    Event,
    GoalRequest,
    Message,
    MessageHeard,
    Response,
    Send,
)
from .heard_facts import ToldFacts
from .jobs import Job, failure, job
from .keys import Keys

SHOWN_S = 1.0  # within it a topic shows what a result has said
REPORT_S = 0.1  # a report at least so often


class Machine:
    """State machine of one device; `step` takes events and returns what is sent, and reports."""

    def __init__(self, devices: Sequence[Robot], keys: Keys) -> None:
        """Raises ValueError unless the device is one of a declared kind."""
        if len(devices) != 1 or not isinstance(devices[0], Device):
            raise ValueError("a mapping is for one device of a declared kind")
        self._name, self._keys = devices[0].name, keys
        self._told = ToldFacts(keys, devices[0])
        ends = [keys.end(call) for _, call in keys.calls]
        self._presence = Presence([*ends, *self._told.topics])
        self._histories = {end: GoalHistory(self._name) for end in ends if end.kind == "action"}
        verbs = {keys.end(verb) for verb in keys.verbs.values()}
        self._numbered = self._histories.get(next(iter(verbs))) if len(verbs) == 1 else None
        kinds, sent = devices[0].kind.verbs.values(), keys.verbs
        published = [each for each in kinds if each.name in sent and sent[each.name].publish]
        motions = [each for each in published if each.effect is Effect.MOTION]
        self._moving = {name for each in motions for name, _ in each.sets}  # facts that change while it moves
        self._jobs: dict[End, Job] = {}
        self._out: list[Message] = []
        self._receipts = Receipts()
        calls = {key: call for key, call in ((STOP, keys.halt), (CLEAR, keys.clear)) if call is not None}
        self._asks = Asks(
            {end: CancelGoals(end=end) for end in self._histories}
            | {key: Send(call=call, id=key) for key, call in calls.items()},
            self._out,
            self._receipts,
            answer_s=keys.answer_s,
            unanswered=[key for key, call in calls.items() if call.publish],
        )
        self._latched, self._why = False, ""
        self._there_at = math.inf  # since when all are there

    def step(self, now: float, events: Sequence[Event]) -> list[Message]:
        """Take events and the time, and return messages to act on; at most one of them is a report."""
        for event in events:
            self._take(now, event)
        why = self._missing(now)
        if why:
            self._lose(now, why)
        else:
            self._there_at = min(self._there_at, now)
            self._asks.pass_time(now)
            for end, each in list(self._jobs.items()):
                self._look(now, end, each)
            if self._receipts.is_due(now, REPORT_S) and now >= self._there_at + SETTLE_S:
                self._out.append(self._receipts.on(now, self._report(now)))
        out = self._out.copy()
        self._out.clear()
        return out

    def _take(self, now: float, event: Event) -> None:
        if isinstance(event, GoalRequest):
            self._ask(now, event)
        elif isinstance(event, EndsFound):
            self._find(now, event)
        elif isinstance(event, MessageHeard):
            self._told.hear(now, event.told, event.message)
        elif isinstance(event, Response):
            self._hear_response(now, event)
        elif isinstance(event, ActionSaid):
            self._hear_action(now, event.end, event.said)
        else:
            self._lose(now, event.why)

    # The link.

    def _missing(self, now: float) -> str:
        return self._presence.missing(now) or self._told.missing(now)

    def _find(self, now: float, event: EndsFound) -> None:
        before = self._presence.boot
        anew = self._presence.find(now, event.found)
        self._told.began_anew(anew)
        if not anew or self._presence.boot == before:
            return
        for end in anew:  # it knows of no goal and no request
            self._jobs.pop(end, None)
            self._asks.forget(end)
            if end in self._histories:
                self._histories[end].forget()
        self._leave_all()
        self._receipts.forget()

    def _lose(self, now: float, why: str) -> None:
        """Lose the link, and open work; goals that still run are cancelled once their servers are back."""
        self._leave_all()
        self._there_at = math.inf
        if why != self._why:
            self._why = why
            self._out.append(lost(self._name, at=now, why=why))

    def _leave_all(self) -> None:
        """Wait for no end any more."""
        self._asks.leave(self._jobs)
        for end, each in list(self._jobs.items()):
            self._leave(end, each)

    def _leave(self, end: End, each: Job) -> None:
        each.stopped = True
        if each.is_over:
            del self._jobs[end]

    # Commands.

    def _ask(self, now: float, request: GoalRequest) -> None:
        command, why = request.command, self._missing(now)
        if why:
            self._out.append(CommandNotSent(why=why))
        elif isinstance(command, Stop):
            self._stop(now, command)
        elif not isinstance(command, VerbCommand) or command.verb not in self._keys.verbs:
            self._out.append(CommandNotSent(why=f"nothing is called for {command.word or 'this'}"))
        elif self._is_busy(command):
            self._receipts.reject(command.id, "busy")
        else:
            self._begin(now, command, request.payload)

    def _is_busy(self, command: VerbCommand) -> bool:
        """True where another work is under way, or something else at the same end."""
        end = self._keys.end(self._keys.verbs[command.verb])
        works = any(each.is_work for each in self._jobs.values()) or self._asks.is_stopping
        return end in self._jobs or self._asks.is_open(end) or (works and isinstance(command, Work))

    def _begin(self, now: float, command: VerbCommand, payload: object) -> None:
        verb, uuid = self._keys.verbs[command.verb], b""
        end = self._keys.end(verb)
        self._told.begin(command.verb, command.sets)
        self._receipts.news = True
        if not verb.publish:
            self._jobs[end] = begun = job(now, command, verb)
            if end in self._histories:
                self._histories[end].begin(command)
                begun.uuid = uuid = self._histories[end].send(begun)
        elif not isinstance(command, Work):
            self._told.end(command.sets)  # it has left, and more is not heard of it
            self._receipts.tell(accepted=command.id, done=command.id)
        self._out.append(Send(call=verb, id=command.id, payload=payload, uuid=uuid))

    def _stop(self, now: float, command: Stop) -> None:
        if command.mode is not StopMode.HALT:
            self._latched = command.mode is StopMode.LATCH
        self._receipts.news = True
        if command.mode is StopMode.CLEAR:
            self._asks.clear(now, command.id)
        elif any(each.finishes for each in self._jobs.values()):
            self._receipts.tell(accepted=command.id)  # it goes on to its own end
        else:
            for end, each in list(self._jobs.items()):
                if not each.is_work and end in self._histories and not each.stopped:
                    self._receipts.tell(failed=each.id, failure="stopped")  # by the cancel
                if each.is_work or end in self._histories:
                    self._leave(end, each)
            self._asks.stop(now, command.id)

    # What is under way.

    def _look(self, now: float, end: End, each: Job) -> None:
        answer_s, is_goal = self._keys.answer_s, end in self._histories
        if each.succeeded_at is not None:
            self._believe(now, end, each, each.succeeded_at)
        elif each.stopped:
            if is_goal and not each.accepted and self._asks.answered_for_s(now, end) >= answer_s:
                del self._jobs[end]  # it was never accepted; where it still is, it is cancelled
        elif is_goal and not each.accepted and now >= each.sent_at + answer_s:
            self._give_up(now, end, each, "goal_not_answered")
        elif now >= each.over_at:
            self._give_up(now, end, each, "not_ended")
        elif each.unknown_at is not None and now >= each.unknown_at + GONE_S:
            self._end(end, failed=each.id, failure="goal_unknown_to_the_server")

    def _give_up(self, now: float, end: End, each: Job, word: str) -> None:
        """Wait no more for an end; what works may still do so, until its server says otherwise."""
        self._receipts.tell(failed=each.id, failure=word)
        each.stopped = True
        if end in self._histories:
            self._asks.begin(now, end)
        elif not each.is_work:
            del self._jobs[end]

    def _believe(self, now: float, end: End, each: Job, succeeded_at: float) -> None:
        """Tell an end once its facts are shown, or were not in time: then the plant says what is wrong."""
        if self._told.shows(each.command.sets) or now >= succeeded_at + SHOWN_S:
            if end in self._histories:
                self._histories[end].end()
            self._end(end, done=each.id)

    def _end(self, end: End, **ids: str) -> None:
        self._jobs.pop(end, None)
        self._receipts.tell(**ids)

    # What is heard.

    def _hear_action(self, now: float, end: End, said: Said) -> None:
        each, history = self._jobs.get(end), self._histories[end]
        if isinstance(said, GoalAnswer):
            history.answer(said.id, accepted=said.accepted)
            if self._asks.hear_goal(now, end, each, said):
                self._end(end)
        elif isinstance(said, GoalList):
            history.list(said.goals)
            running = [goal.uuid for goal in said.goals if goal.status is None]
            is_ended = each is not None and each.stopped and each.accepted and each.uuid not in running
            if is_ended and not self._asks.is_open(end):
                self._end(end)  # it was cancelled, and its server knows of it no more
        elif isinstance(said, CancelAnswer):
            is_refused = said.refused and each is not None and not self._asks.calls_stop
            if not is_refused:
                history.leave_behind()
            self._asks.answer(now, end, "cancel_refused" if is_refused else "")
        elif each is not None and said.id == each.key and not each.is_over:
            self._hear_result(now, end, each, said)

    def _hear_result(self, now: float, end: End, each: Job, result: GoalResult) -> None:
        if each.stopped:
            self._end(end)
        elif result.status is Status.UNKNOWN:
            each.unknown_at = now  # most likely it was started anew, which is seen only at the next look
        else:
            self._finish(now, end, each, result.status, result.message)

    def _hear_response(self, now: float, response: Response) -> None:
        call = {STOP: self._keys.halt, CLEAR: self._keys.clear}.get(response.id)
        if call is not None:
            self._asks.answer(now, response.id, failure(call, Status.SUCCEEDED, response.message))
            return
        for end, each in list(self._jobs.items()):
            if each.id == response.id and each.stopped:
                self._end(end)
            elif each.id == response.id:
                self._receipts.tell(accepted=each.id)
                status = Status.ABORTED if response.message is None else Status.SUCCEEDED
                self._finish(now, end, each, status, response.message)

    def _finish(self, now: float, end: End, each: Job, status: Status, message: object) -> None:
        """Take the end of a goal or a request, which answers a query or changes facts."""
        if message is not None:
            self._told.hear(now, ("result", each.command.verb), message)
        answer = each.verb.answer
        if word := failure(each.verb, status, message):
            self._end(end, failed=each.id, failure=word)
        elif each.command.definition.effect is not Effect.QUERY or answer is None:
            self._told.end(each.command.sets)
            each.succeeded_at = now
        else:
            self._jobs.pop(end)
            raw, of = field_at(answer.field, message), each.command.definition.answer_type
            try:
                self._receipts.answer(each.id, answer.value(raw, of, answer.field))
            except DriverError as error:
                self._receipts.tell(failed=each.id, failure=plain(str(error), LONGEST_WORD))

    # What the plant hears.

    def _state(self, now: float) -> MotionState:
        told = STATES[self._told.state]
        at_work = self._asks.is_stopping or any(each.is_work for each in self._jobs.values())
        goes_on = any(history.has_earlier_goal for history in self._histories.values())
        if told is not MotionState.STOPPED:
            return told
        if at_work or goes_on or self._told.changes(now, self._moving):
            return MotionState.MOVING
        return MotionState.STOP_LATCHED if self._latched else told

    def _report(self, now: float) -> Report:
        self._why = ""
        numbered = self._numbered
        return Report(
            at=now,
            robot=self._name,
            boot_id=self._presence.boot,
            state=self._state(now),
            facts=self._told.facts,
            unknown=self._told.unknown,
            receipt=None if numbered is None else numbered.receipt,
            tokens=None if numbered is None else numbered.tokens,
        )
