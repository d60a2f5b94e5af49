"""The plant in its loop, and its listeners."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import replace
from typing import Any, NamedTuple

from arboleda.adapters import clock
from arboleda.departures.leading import Standing, may_leave
from arboleda.departures.leaving import (
    SENT_TOO_LATE,
    StopLeft,
    Unkept,
    departure,
    done_at_once,
    is_too_late,
    late_departure,
    leaves_unkept,
    stop_left,
)
from arboleda.engine import Plant
from arboleda.host.pieces import Pieces
from arboleda.model.commands import Command, Stop
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import (
    Absence,
    CellRevised,
    ClockSet,
    Event,
    Fact,
    InternalError,
    Journal,
    KeptTask,
    Notice,
    OperatorAnswer,
    OperatorRequest,
    Remember,
    Report,
    RestartRequest,
    Revision,
    RevisionAnswer,
    RevisionName,
    Shutdown,
    TaskChanged,
    TaskRequest,
    TaskState,
    Undelivered,
    Verb,
)
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import PlantModel
from arboleda.model.sentence import Phrase, as_sentence
from arboleda.model.verbs import Arguments
from arboleda.store.lead import Superseded
from arboleda.store.plant_memory import PlantMemory
from arboleda.store.task_rows import COMMAND, History, TaskQuery

from ..loop import Loop
from ..memory import begun, kept_task, kept_tasks, remembered
from .askers import Askers
from .earlier_tasks import EarlierTasks
from .keeping import Keeping
from .listeners import LeaveOut, Listeners
from .part import Crash
from .plant_log import OPERATORS, TASKS, Durable, log_act, log_answer, log_defect
from .router import PlantPort
from .screens import RosPort, Screens
from .stops import ActsDone, CommandOvertaken, Stops, StopsAway
from .urgency import Urgency

LOG = logging.getLogger(__name__)
PATIENCE_S = 6.0  # a stop is confirmed within stop_timeout_s, 5 s in the shipped plant
AWAY = "the plant was away for %.1f s; cells that were at work are held, see `arboleda status`"


IN_DOUBT = Phrase(
    "plant.task_in_doubt",
    "{why} The task may have been kept all the same: look at the tasks after the next start, before you send"
    " it again without an id",
)


class Facts(NamedTuple):
    """Facts of a step between which no other message leaves: they are kept by one write."""

    facts: list[Remember]


class CommandsLeft(NamedTuple):
    """Mark at the end of a step's messages: what was only noted before its commands is to be committed."""


COMMANDS_LEFT = CommandsLeft()


class PutToWork(NamedTuple):
    """A version that is to be put to work while the plant runs: who does it, and what it changes."""

    version: RevisionName
    model: PlantModel
    files: PlantFiles
    by: str
    changes: tuple[str, ...]


class StartState(NamedTuple):
    """The values that a plant was made of beside its file and its epoch: its clock's time, and its memory."""

    now: float
    memory: Mapping[Fact, Mapping[str, str]]
    kept: Sequence[KeptTask]


class CommandTooLate(ArboledaError):
    """A command was not sent: it is older than the longest allowed silence of a robot."""


class Orchestrator:
    """The plant in its loop; `connect` its port before `start`.

    By `keeping`, facts that the plant wants remembered are in the `store` before any later message leaves;
    only stops leave earlier. Nobody is told anything before all that led to it is durable, which the loop
    does not wait for: neither `askers` nor `listeners` nor `screens`. If the store fails, the plant ends:
    from then on it sends only stops. Tasks that wait at the end are left for the next start, unless it
    `drops_waiting`. If its thread is busy when somebody asks for a stop, the stop leaves beside it, by
    `stops`.

    `leave_out` leaves out the listener of a package that raised.
    """

    def __init__(
        self,
        model: PlantModel,
        epoch: int,
        crash: Crash,
        store: PlantMemory | None = None,
        *,
        history: History | None = None,
        drops_waiting: bool = False,
        leave_out: LeaveOut | None = None,
        calendar: clock.Calendar | None = None,
    ) -> None:
        self.calendar = calendar or clock.Calendar()
        now, memory = clock.seconds(), remembered(store) if store is not None else {}
        kept = kept_tasks(store, clock_s=now, unix_s=self.calendar.unix_s()) if store is not None else []
        if store is not None:
            memory = begun(store, memory, kept)
        self.plant = Plant(model, epoch=epoch, now=now, memory=memory, kept=kept)
        self.began = StartState(now, memory, kept)
        self.loop: Loop[Any, Any] = Loop(
            "orchestrator",
            self.plant,
            self._send,
            on_crash=crash,
            on_send_error=self._not_sent,
            arrange=self._arrange,
            on_step=self._stepped,
        )
        self.stops = Stops(model, epoch, self._send_beside)
        self.keeping = Keeping(self.plant, store, self._tell, crash, self.calendar)
        self.askers = Askers()
        leave_out = leave_out or Pieces().leave_out
        self.listeners: Listeners[TaskChanged] = Listeners(leave_out)
        self.observers: Listeners[Plant] = Listeners(leave_out)  # told after each step; they must not wait
        self.observers.append(EarlierTasks(self.plant).stepped)
        self.screens = Screens(self.plant, self.loop, self.keeping, leave_out)
        self.reacted: Callable[[float], None] = lambda _seconds: None
        self._history = history
        self._drops_waiting = drops_waiting
        self._port: PlantPort | None = None
        self._urgency = Urgency(self.plant)
        self._at_rest = threading.Event()
        self._for_process: Mapping[type, Callable[[Any], None]] = {
            Facts: lambda message: self.keeping.keep_facts(message.facts),
            Journal: self._keep_act,
            StopsAway: self.stops.departed,
            ActsDone: self.stops.happened,
            CommandsLeft: lambda _: self.keeping.settle(),
            InternalError: lambda message: log_defect(message.cell or "plant", message.error),
            Absence: lambda message: LOG.warning(AWAY, message.seconds),
        }
        """Uses of messages of a step that neither leave nor wait to be told."""

    def hear(self, event: Event) -> None:
        """Take an event of the port, in the port's thread; a report without news may wait for others."""
        if isinstance(event, OperatorRequest):
            self._take(event)
            return
        if isinstance(event, TaskRequest):
            event = self._recalled(event)
        self.loop.post(event, self._urgency.within_s(event) if isinstance(event, Report) else 0.0)

    def _recalled(self, request: TaskRequest) -> TaskRequest:
        """The request, with the task of that id if it ended too long ago for the plant to know it."""
        id = request.text.rpartition("#")[2]
        if self._history is None or id == request.text or id in self.plant.intake.tasks:
            return request
        found = self._history.select(TaskQuery(id=id, is_open=False, limit=1))
        kept = [kept_task(row, clock_s=request.at, unix_s=self.calendar.unix_s()) for row in found]
        return replace(request, kept=next(iter(kept), None))

    def connect(self, port: PlantPort) -> None:
        self._port = port

    def connect_ros(self, port: RosPort) -> None:
        """Connect the ROS side that shows the plant; its commands come by the port of `connect`."""
        self.screens.ros = port

    def start(self) -> None:
        """Start the plant; StartError if another node already commands these robots.

        With a database that names the leader nothing is checked: the other node can only be the leader
        before, which ends or was cut off, and nobody obeys it.
        """
        store, ros = self.keeping.store, self.screens.ros
        if ros is not None and (store is None or store.lead.renew_s is None):
            ros.check_alone()
        for run in self.plant.cells.values():
            if run.queue.left_over:
                TASKS.warning("%s", run.queue.why_paused)
        self.screens.open()
        self.keeping.durability.start()
        self.stops.loop.start()
        self.loop.start()

    def submit(
        self, text: str, asked_by: str = COMMAND, choice: str = "", version: str = ""
    ) -> Future[TaskChanged]:
        """Ask for a task; the future holds the answer: queued, refused, or the known task's state.

        `choice` is the reason for which it goes to its cell, if somebody chose between plants; `version` the
        digest of the only version of the plant for which it is allowed, if it is not for any.
        """
        answer, request_id = self.askers.expect(asked_by)
        self.hear(
            TaskRequest(at=clock.seconds(), text=text, request=request_id, choice=choice, version=version)
        )
        return answer

    def operate(
        self, verb: Verb, scope: str = "", *, by_hand: bool = False, arguments: Arguments = ()
    ) -> Future[OperatorAnswer]:
        """Ask for an operator's act; the future holds the answer, with a refusal where nothing was done."""
        answer, request_id = self.askers.expect()
        self._take(
            OperatorRequest(
                at=clock.seconds(),
                verb=verb,
                scope=scope,
                by_hand=by_hand,
                arguments=arguments,
                request=request_id,
            )
        )
        return answer

    def revise(self, put: PutToWork) -> Future[RevisionAnswer]:
        """Put a version to work, which each cell takes between two tasks; the future says which wait."""
        self.plant.versions[put.version.digest] = put.model
        if self.screens.recorder is not None:  # before the first step that is told of it
            self.screens.recorder.knows(put.version.digest, put.files)
        answer, request_id = self.askers.expect()
        self.hear(
            Revision(
                at=clock.seconds(), version=put.version, by=put.by, changes=put.changes, request=request_id
            )
        )
        return answer

    def restart_at_rest(self, by: str, *, wanted: bool) -> None:
        """Have no further task begin, so that the plant can be restarted; or have them begin again."""
        self.hear(RestartRequest(at=clock.seconds(), by=by, wanted=wanted))

    def _take(self, request: OperatorRequest) -> None:
        """Give the plant an operator's request; a stop does not wait until the plant's thread is free."""
        if not request.verb.row.stops:
            if request.verb is Verb.HOLD and request.request:
                self.stops.expect(request)
            self.loop.post(request)
            return
        request = self.stops.open(request)
        self.loop.post(request)
        # Where the thread is free, the step that takes the stop sends it first.
        if self.loop.busy and self.keeping.leads_for_certain:
            self.stops.leave_beside(request)

    def tell(self, *messages: Journal | OperatorAnswer) -> None:
        """Keep and tell what is of no step; from an observer, in the plant's thread."""
        for message in messages:
            self._send(message)
        self.keeping.durability.wake()

    def halt(self) -> None:
        """Halt whatever moves, accept nothing more, and wait for nothing."""
        self.loop.post(Shutdown(at=clock.seconds(), drops_waiting=self._drops_waiting))

    def stop(self) -> None:
        """Halt whatever moves and wait until the robots confirm it, at most PATIENCE_S."""
        self.halt()
        if self.loop.running:
            self._at_rest.wait(PATIENCE_S)
        self.loop.stop()
        self.keeping.durability.stop()
        self.stops.loop.stop()

    def _send(self, message: Any) -> None:
        """Do with a message what it is for; one that leaves waits for what has to be kept before it."""
        for_process = self._for_process.get(type(message))
        if for_process is not None:
            for_process(message)
        elif self.keeping.failure is not None and not leaves_unkept(message):
            self._refuse_unkept(message, self.keeping.failure)
        elif isinstance(message, CellRevised):
            OPERATORS.info("%s works by version %d from now on", message.cell, message.version.number)
        elif isinstance(message, Durable):
            if isinstance(message, TaskChanged):
                self.keeping.keep_task(message, self.askers.way_of(message.request))
            self.keeping.settle()
            self.keeping.durability.tell(message)
        elif self._port is not None and self.keeping.lets_leave(message):
            self._let_leave(message, self._port)

    def _let_leave(self, message: Any, port: PlantPort) -> None:
        if not leaves_unkept(message):
            self.keeping.durability.let_commands_leave()
        if is_too_late(message, self.plant, now := clock.seconds()):
            raise CommandTooLate(SENT_TOO_LATE(seconds=now - self.plant.now))
        if self.stops.ahead:
            self.stops.refuse_overtaken(message)
        port.send(message)
        if late := late_departure(message, self.plant, clock.seconds()):
            self.loop.post(late)
        if self.stops.ahead:  # one may have left meanwhile
            self.stops.stop_again(message)

    def _keep_act(self, message: Journal) -> None:
        log_act(message)
        self.keeping.keep_act(message)

    def _tell(self, message: Durable, failure: Exception | None) -> None:
        """Tell whoever waits for it of a change that is durable, or that it is not; in the thread of that."""
        if failure is not None:
            self._refuse_unkept(message, _in_doubt(message, failure))
            return
        log_answer(message)
        self._answer(message)
        if isinstance(message, TaskChanged):
            self.listeners.tell(message)
        if isinstance(message, RevisionAnswer):
            return
        if self._port is not None and may_leave(message, self.keeping.standing):
            self._port.send(message)

    def _send_beside(self, message: Stop | Unkept) -> None:
        """Send a message of the lane, in its thread."""
        if isinstance(message, Unkept):
            self.askers.answer(message.request, message)
        if self._port is not None and self.keeping.standing is not Standing.SUPERSEDED:
            self._port.send(message)

    def _refuse_unkept(self, message: Command | Notice, failure: Exception) -> None:
        """Refuse the requests that wait for an answer, as nothing is kept; nobody hears of unkept changes."""
        if isinstance(message, Command):
            raise failure
        if isinstance(message, Durable):
            self._answer(message, failure)
        if isinstance(message, OperatorAnswer):
            refusal = self._unkept(message, failure)
            log_answer(refusal)
            if self._port is not None:
                self._port.send(refusal)

    def _unkept(self, answer: OperatorAnswer, why: Exception) -> OperatorAnswer:
        """The answer to an act that is not kept: only a stop has left all the same."""
        is_left = answer.verb.row.stops and answer.refusal is None
        if is_left and self.keeping.standing is not Standing.SUPERSEDED:
            return stop_left(answer, as_sentence(why))
        return replace(answer, refusal=answer.refusal or as_sentence(why))

    def _arrange(self, messages: Sequence[Any]) -> Sequence[Any]:
        """The messages of a step in the order in which they leave: its stops wait for no commit."""
        stops: Sequence[Any] = ()
        if Stop in map(type, messages):
            stops, messages, overtaken = departure(messages)
            for command in overtaken:
                self._not_sent(command, CommandOvertaken(command))
        if self.stops.ahead and (away := self.stops.stepped(messages)) is not None:
            stops = [*stops, away]
        keeps = self.keeping.store is not None and self.keeping.leads_for_certain
        if keeps and OperatorAnswer in map(type, messages) and (acts := done_at_once(messages)):
            stops = [*stops, ActsDone(acts)]
        if stops or Remember in map(type, messages):
            return [*stops, *_bundled(messages), COMMANDS_LEFT]
        return messages

    def _answer(self, answer: Durable, failure: Exception | None = None) -> None:
        reply: Durable | Exception = answer if failure is None else failure
        if isinstance(answer, OperatorAnswer):
            self.stops.closed(answer)
            if failure is not None and isinstance(unkept := self._unkept(answer, failure), StopLeft):
                reply = unkept
        self.askers.answer(answer.request, reply)

    def _not_sent(self, message: Any, error: Exception) -> None:
        if isinstance(message, Facts | Journal | TaskChanged | CommandsLeft):
            self.keeping.fail(error)
            if isinstance(message, TaskChanged):
                self._answer(message, _in_doubt(message, error))
        elif isinstance(message, Command):
            event = Undelivered(
                at=clock.seconds(), id=message.id, robot=message.robot, sentence=as_sentence(error)
            )
            self.loop.post(event)
        else:
            raise error

    def _stepped(self, now: float, events: Sequence[Any], messages: Sequence[Any]) -> None:
        if events and any(isinstance(message, Command) for message in messages):
            # What is no news may have waited for the last event, which is why this step was made.
            self.reacted(clock.seconds() - max(event.at for event in events))
        if by_s := self.keeping.follow_clock():
            self.loop.post(ClockSet(at=clock.seconds(), seconds=by_s))
        self.keeping.durability.wake()
        if self.screens.recorder is not None:
            self.screens.recorder.stepped(self.plant, now, events, messages)
        if self.keeping.failure is None:
            self.observers.tell(self.plant)
        if self.plant.intake.closed and self.plant.at_rest:
            self._at_rest.set()
        self.screens.stepped(now)


def _in_doubt(message: Durable, failure: Exception) -> Exception:
    """The failure to keep a message that was written: nobody knows whether the next start finds a task."""
    if not isinstance(message, TaskChanged) or message.state is not TaskState.QUEUED:
        return failure
    return failure if isinstance(failure, Superseded) else ArboledaError(IN_DOUBT(why=as_sentence(failure)))


def _bundled(messages: Sequence[Any]) -> list[Any]:
    """The messages of a step, with all facts in a row as one."""
    bundled: list[Any] = []
    last: list[Remember] | None = None
    for each in messages:
        if not isinstance(each, Remember):
            last = None
            bundled.append(each)
        elif last is None:
            last = [each]
            bundled.append(Facts(last))
        else:
            last.append(each)
    return bundled
