"""The plant in its loop, and its listeners."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from concurrent.futures import Future
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple, Protocol
from uuid import uuid4

from arboleda.adapters import clock
from arboleda.departures.leading import Standing, may_leave
from arboleda.departures.leaving import (
    SENT_TOO_LATE,
    StopLeft,
    Unkept,
    departure,
    done_at_once,
    ends_motion,
    is_too_late,
    late_departure,
    leaves_unkept,
    stop_left,
)
from arboleda.engine import Memory, Plant, reasons
from arboleda.model.commands import Command, Stop
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import (
    ENDED,
    Absence,
    CellRevised,
    Event,
    InternalError,
    Journal,
    KeptTask,
    Notice,
    OperatorAnswer,
    OperatorRequest,
    Outcome,
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
from arboleda.model.sentence import Phrase, Sentence, as_sentence
from arboleda.model.verbs import Arguments
from arboleda.store.plant_memory import PlantMemory, Superseded
from arboleda.store.task_rows import COMMAND, ROS, History, TaskQuery
from arboleda.views import diagnostics, twin_view, view
from arboleda.views.resting_cells import RestingCells

from ..loop import Loop, StepInFlight
from ..memory import begun, kept_task, kept_tasks, remembered
from .durability import Durability
from .listeners import Listeners
from .part import Crash
from .router import PlantPort
from .slices import PAUSE_S, Slices
from .stops import ActsDone, CommandOvertaken, Stops, StopsAway
from .urgency import Urgency

LOG = logging.getLogger(__name__)
TASKS = logging.getLogger("arboleda.tasks")
REQUESTS = logging.getLogger("arboleda.requests")  # those that were refused
OPERATORS = logging.getLogger("arboleda.operators")
VIEW_S = 1.0
# A snapshot takes as long as several steps: it waits until whoever was sent a command had the processor.
SETTLE_S = 0.01
SHARE = 0.1  # of the thread's time for snapshots, at most: one of 100 busy cells takes as long as 500 steps
DAY_S = 86_400.0
PATIENCE_S = 6.0  # a stop is confirmed within stop_timeout_s, 5 s in the shipped plant
READ_S = 1.0  # from a step on, for a reader to wait for its commits
GLANCE_S = 0.03  # the same in the server's thread, where the next stop waits, too


IN_CELL = Phrase("act.in_cell", "{did} ({cell})")
VERB_REFUSED = Phrase("act.verb_refused", "{verb} {scope} was refused: {why}")
NOT_KEPT = Phrase(
    "plant.not_kept", "the plant has not kept yet what it did last, so it cannot tell of it; ask again later"
)


class FlightRecorder(Protocol):
    """The writer of the flight record: gets each step and each snapshot in the plant's thread.

    `trouble` is the reason for which it stopped.
    """

    trouble: str

    def stepped(self, plant: Plant, now: float, events: Sequence[Any], messages: Sequence[Any]) -> None: ...
    def saw(self, snapshot: dict[str, Any], drawn: dict[str, Any]) -> None: ...
    def knows(self, digest: str, files: PlantFiles) -> None: ...


Durable = TaskChanged | OperatorAnswer | RevisionAnswer
"""What is told once all that led to it is durable."""


class Facts(NamedTuple):
    """Facts of a step between which no other message leaves: they are kept by one write."""

    facts: list[Remember]


class CommandsLeft(NamedTuple):
    """Mark at the end of a step's messages: what was only noted before its commands is to be committed."""


COMMANDS_LEFT = CommandsLeft()


class RosPort(PlantPort, Protocol):
    """The plant's port on ROS 2, which carries snapshots too and knows whether it is alone."""

    @property
    def watched(self) -> bool: ...
    @property
    def diagnosed(self) -> bool: ...
    def check_alone(self) -> None: ...
    def publish_view(self, view: dict[str, Any]) -> Iterator[None]: ...
    def publish_diagnostics(self, statuses: Iterable[diagnostics.Diagnostic]) -> Iterator[None]: ...


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
    memory: Memory
    kept: Sequence[KeptTask]


class KeptStateUnknown(ArboledaError):
    """Nobody can tell now how much of the plant is kept."""

    def __init__(self) -> None:
        super().__init__(NOT_KEPT())


class CommandTooLate(ArboledaError):
    """A command was not sent: it is older than the longest allowed silence of a robot."""


class Orchestrator:
    """The plant in its loop; `connect` its port before `start`.

    Facts that the plant wants remembered are in the `store` before any later message leaves; only stops leave
    earlier. Nobody is told anything before all that led to it is durable, which the loop does not wait for.
    If the store fails, the plant ends: from then on it sends
    only stops, and screens show the last kept snapshot. Tasks that wait at the end are left for the next
    start, unless it `drops_waiting`. If its thread is busy when somebody asks for a stop, the stop leaves
    beside it, by `stops`.

    `leave_out_raiser` gets what a listener raises, and leaves out the package of that; False where it is of
    none.
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
        leave_out_raiser: Callable[[Exception], bool] = lambda _: False,
    ) -> None:
        now, memory = clock.seconds(), remembered(store) if store is not None else {}
        kept = kept_tasks(store, clock_s=now, unix_s=time.time()) if store is not None else []
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
        self.durability = Durability(store, self._tell, self._forget)
        gives_up = partial(_gives_up, leave_out_raiser)
        self.listeners: Listeners[TaskChanged] = Listeners(gives_up)
        self.watchers: Listeners[dict[str, Any]] = Listeners(gives_up)
        self.observers: Listeners[Plant] = Listeners(gives_up)  # told after each step; they must not wait
        self.reacted: Callable[[float], None] = lambda _seconds: None
        self.recorder: FlightRecorder | None = None
        self.diagnoses: list[
            Callable[[], diagnostics.Diagnostic]
        ] = []  # of parts other than robots and cells
        self._store = store
        self._history = history
        self._drops_waiting = drops_waiting
        self._crash = crash
        self._amnesia: Exception | None = None
        self._noted = False  # whether facts are written that are not committed
        self._port: PlantPort | None = None
        self._ros: RosPort | None = None
        self._shown = (-1, 0.0)
        self._show_after = 0.0
        self._resting = RestingCells()
        self._kept: dict[str, Any] = {}  # the last snapshot of what was kept, as screens got it
        self._blind = ""  # the defect for which screens saw nothing last
        self._show_at: float | None = None  # while there is a change that nobody was shown
        self._showing: Slices[None] | None = None  # a snapshot that is being made and shown
        self._shown_from = 0  # the number of the write that has to be durable before it is shown
        self._urgency = Urgency(self.plant)
        self._waiting: dict[str, Future[Any]] = {}
        self._asked_by: dict[str, str] = {}  # by token, the way by which a task came
        self._at_rest = threading.Event()

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
        kept = [kept_task(row, clock_s=request.at, unix_s=time.time()) for row in found]
        return replace(request, kept=next(iter(kept), None))

    def connect(self, port: PlantPort) -> None:
        self._port = port

    def connect_ros(self, port: RosPort) -> None:
        """Connect the ROS side that shows the plant; its commands come by the port of `connect`."""
        self._ros = port

    def start(self) -> None:
        """Start the plant; StartError if another node already commands these robots.

        With a database that names the leader nothing is checked: the other node can only be the leader
        before, which ends or was cut off, and nobody obeys it.
        """
        if self._ros is not None and (self._store is None or self._store.renew_s is None):
            self._ros.check_alone()
        for run in self.plant.cells.values():
            if reasons.of_earlier_task(run) is not None:
                TASKS.warning("%s", reasons.of_earlier_task(run))
            if run.queue.left_over:
                TASKS.warning("%s", run.queue.why_paused)
        self._kept = self._first_view()
        self.durability.start()
        self.stops.loop.start()
        self.loop.start()

    def _first_view(self) -> dict[str, Any]:
        """A snapshot for those who look before the first one that screens get."""
        try:
            return view.snapshot(self.plant)
        except Exception as error:  # noqa: BLE001 - a screen that cannot be drawn must not end the plant
            _log_defect("the screens", error)
            return {}

    def submit(
        self, text: str, asked_by: str = COMMAND, choice: str = "", version: str = ""
    ) -> Future[TaskChanged]:
        """Ask for a task; the future holds the answer: queued, refused, or the known task's state.

        `choice` is the reason for which it goes to its cell, if somebody chose between plants; `version` the
        digest of the only version of the plant for which it is allowed, if it is not for any.
        """
        answer, token = self._expect()
        self._asked_by[token] = asked_by
        self.hear(TaskRequest(at=clock.seconds(), text=text, request=token, choice=choice, version=version))
        return answer

    def operate(
        self, verb: Verb, scope: str = "", *, by_hand: bool = False, arguments: Arguments = ()
    ) -> Future[OperatorAnswer]:
        """Ask for an operator's act; the future holds the answer, with a refusal where nothing was done."""
        answer, token = self._expect()
        self._take(
            OperatorRequest(
                at=clock.seconds(),
                verb=verb,
                scope=scope,
                by_hand=by_hand,
                arguments=arguments,
                request=token,
            )
        )
        return answer

    def revise(self, put: PutToWork) -> Future[RevisionAnswer]:
        """Put a version to work, which each cell takes between two tasks; the future says which wait."""
        self.plant.versions[put.version.digest] = put.model
        if self.recorder is not None:  # before the first step that is told of it
            self.recorder.knows(put.version.digest, put.files)
        answer, token = self._expect()
        self.hear(
            Revision(at=clock.seconds(), version=put.version, by=put.by, changes=put.changes, request=token)
        )
        return answer

    def restart_at_rest(self, by: str, *, wanted: bool) -> None:
        """Have no further task begin, so that the plant can be restarted; or have them begin again."""
        self.hear(RestartRequest(at=clock.seconds(), by=by, wanted=wanted))

    def _take(self, request: OperatorRequest) -> None:
        """Give the plant an operator's request; a stop does not wait until the plant's thread is free."""
        if not request.verb.row.stops:
            self.loop.post(request)
            return
        request = self.stops.open(request)
        self.loop.post(request)
        if self.loop.busy and self._leads_for_certain:  # a step that has taken it sends its stops first
            self.stops.leave_beside(request)

    @property
    def _leads_for_certain(self) -> bool:
        """True if a stop may leave without asking the store, which may hang."""
        if self._store is None or self._amnesia is not None:
            return self._standing is not Standing.SUPERSEDED
        return self._store.leads_for_certain

    def snapshot(self, within_s: float = READ_S) -> dict[str, Any]:
        """A snapshot of what is kept, made in slices between which the plant is stepped; not in its thread.

        While the plant waits longer for its disk, it is the last snapshot that screens got.
        """
        slices = Slices(view.in_parts(self.plant, self._resting.part))
        try:
            while not self._read(lambda _plant: slices.cut(clock.seconds()), within_s):
                time.sleep(PAUSE_S)
            self._require_durable(within_s)
        except StepInFlight:
            return self._last_kept
        return slices.result

    def _read(self, fn: Callable[[Plant], Any], within_s: float) -> Any:
        """`fn(plant)` once all of the plant is kept; StepInFlight if it is not in time, or never will be."""

        def look(plant: Plant) -> Any:
            if self._amnesia is not None:
                raise StepInFlight
            return fn(plant)

        return self.loop.read_handed_on(look, within_s)

    def _require_durable(self, within_s: float) -> None:
        """Wait until all that was read is durable; raises StepInFlight if it is not in time."""
        if not self.durability.reach(self.durability.hurry(), within_s):
            raise StepInFlight

    @property
    def _last_kept(self) -> dict[str, Any]:
        """The last snapshot that screens got; KeptStateUnknown if there is none."""
        if not self._kept:
            raise KeptStateUnknown
        return self._kept if self._amnesia is None else {**self._kept, "ending": True}

    @property
    def stepped_at(self) -> float:
        """The time of the plant's last step, on its clock; it makes one for each of its heartbeats."""
        now: float = self.loop.read(lambda plant: plant.now)
        return now

    def positions(self) -> dict[str, Any]:
        """The positions of everything that moves; `now` is on the plant's clock."""
        return {"now": clock.seconds(), **self.loop.read(twin_view.positions)}

    def find(self, task: str) -> dict[str, Any] | None:
        """A task as it is kept; KeptStateUnknown if that is unknown now."""
        try:
            found: dict[str, Any] | None = self._read(lambda plant: view.task_by_id(plant, task), READ_S)
            self._require_durable(READ_S)
        except StepInFlight:
            found = next((row for row in self._last_kept["tasks"] if row["id"] == task), None)
            if found is None:
                raise KeptStateUnknown from None
        return found

    def halt(self) -> None:
        """Halt whatever moves, accept nothing more, and wait for nothing."""
        self.loop.post(Shutdown(at=clock.seconds(), drops_waiting=self._drops_waiting))

    def stop(self) -> None:
        """Halt whatever moves and wait until the robots confirm it, at most PATIENCE_S."""
        self.halt()
        if self.loop.running:
            self._at_rest.wait(PATIENCE_S)
        self.loop.stop()
        self.durability.stop()
        self.stops.loop.stop()

    def _send(self, message: Command | Notice | Facts | StopsAway | ActsDone | CommandsLeft) -> None:
        if isinstance(message, Facts):
            self._keep_facts(message.facts)
            return
        if isinstance(message, Journal):
            self._keep_act(message)
            return
        if isinstance(message, StopsAway):
            self.stops.departed(message)
            return
        if isinstance(message, ActsDone):
            self.stops.happened(message)
            return
        if isinstance(message, CommandsLeft):
            self._settle()
            return
        if isinstance(message, InternalError):
            _log_defect(message.cell or "plant", message.error)
            return
        if isinstance(message, Absence):
            LOG.warning(
                "the plant was away for %.1f s; cells that were at work are held, see `arboleda status`",
                message.seconds,
            )
            return
        if self._amnesia is not None and not leaves_unkept(message):
            self._refuse_unkept(message, self._amnesia)
            return
        if isinstance(message, CellRevised):
            OPERATORS.info("%s works by version %d from now on", message.cell, message.version.number)
            return
        if isinstance(message, TaskChanged):
            self._keep_task(message)
        if isinstance(message, Durable):
            self._settle()
            self.durability.tell(message)
        elif self._port is not None and self._may_leave(message):
            if not leaves_unkept(message):
                self.durability.let_commands_leave()
            self._refuse_late(message)
            if self.stops.ahead:
                self.stops.refuse_overtaken(message)
            self._port.send(message)
            if late := late_departure(message, self.plant, clock.seconds()):
                self.loop.post(late)
            if self.stops.ahead:  # one may have left meanwhile
                self.stops.stop_again(message)

    def _tell(self, message: Durable, failure: Exception | None) -> None:
        """Tell whoever waits for it of a change that is durable, or that it is not; in the thread of that."""
        if failure is not None:
            self._refuse_unkept(message, failure)
            return
        _log(message)
        self._answer(message)
        if isinstance(message, TaskChanged):
            self.listeners.tell(message)
        if isinstance(message, RevisionAnswer):
            return
        if self._port is not None and may_leave(message, self._standing):
            self._port.send(message)

    def _send_beside(self, message: Stop | Unkept) -> None:
        """Send a message of the lane, in its thread."""
        if isinstance(message, Unkept):
            waiting = self._waiting.pop(message.request or "", None)
            if waiting is not None:
                waiting.set_result(message)
        if self._port is not None and self._standing is not Standing.SUPERSEDED:
            self._port.send(message)

    def _may_leave(self, message: Command | Notice) -> bool:
        """True if this plant may send a message: once another process has taken it over it sends nothing, not
        even a stop; if it cannot find out, it stops what moves, and ends. A stop does not wait to find out
        while this process leads for certain: at 100 cells the files would be looked at 400 times."""
        if ends_motion(message) and self._leads_for_certain:
            return True
        if self._store is not None and self._amnesia is None:
            try:
                self._store.confirm()
            except ArboledaError as error:
                self._forget(error)
        leaves = may_leave(message, self._standing)
        if not leaves and isinstance(message, Command) and self._amnesia is not None:
            raise self._amnesia
        return leaves

    @property
    def _standing(self) -> Standing:
        if self._amnesia is None:
            return Standing.LEADS
        return Standing.SUPERSEDED if isinstance(self._amnesia, Superseded) else Standing.UNSURE

    def _forget(self, error: Exception) -> None:
        """End the plant, as nothing can be kept any more."""
        self._amnesia = error
        self._crash("orchestrator", error)

    def _refuse_unkept(self, message: Command | Notice, amnesia: Exception) -> None:
        """Refuse the requests that wait for an answer, as nothing is kept; nobody hears of unkept changes."""
        if isinstance(message, Command):
            raise amnesia
        if isinstance(message, Durable):
            self._answer(message, amnesia)
        if isinstance(message, OperatorAnswer):
            refusal = self._unkept(message, amnesia)
            _log(refusal)
            if self._port is not None:
                self._port.send(refusal)

    def _unkept(self, answer: OperatorAnswer, why: Exception) -> OperatorAnswer:
        """The answer to an act that is not kept: only a stop has left all the same."""
        is_left = answer.verb.row.stops and answer.refusal is None
        if is_left and self._standing is not Standing.SUPERSEDED:
            return stop_left(answer, as_sentence(why))
        return replace(answer, refusal=answer.refusal or as_sentence(why))

    def _refuse_late(self, message: Command | Notice) -> None:
        """Raise CommandTooLate if the process was stopped within a step: its commands may now be wrong."""
        now = clock.seconds()
        if is_too_late(message, self.plant, now):
            raise CommandTooLate(SENT_TOO_LATE(seconds=now - self.plant.now))

    def _arrange(self, messages: Sequence[Any]) -> Sequence[Any]:
        """The messages of a step in the order in which they leave: its stops wait for no commit."""
        stops: Sequence[Any] = ()
        if Stop in map(type, messages):
            stops, messages, overtaken = departure(messages)
            for command in overtaken:
                self._not_sent(command, CommandOvertaken(command))
        if self.stops.ahead and (away := self.stops.stepped(messages)) is not None:
            stops = [*stops, away]
        keeps = self._store is not None and self._leads_for_certain
        if keeps and OperatorAnswer in map(type, messages) and (acts := done_at_once(messages)):
            stops = [*stops, ActsDone(acts)]
        if stops or Remember in map(type, messages):
            return [*stops, *_bundled(messages), COMMANDS_LEFT]
        return messages

    def _keep_act(self, message: Journal) -> None:
        level = logging.WARNING if message.outcome is Outcome.FAILED else logging.INFO
        line = act_line(message)
        OPERATORS.log(level, "%s", line, extra={"sentence": line})
        if self._store is None or self._amnesia is not None:
            return
        self._store.journal(message, time.time())
        self._wrote(message)
        if message.verb is Verb.RETRY and message.outcome is None:
            for name in [message.cell] if message.cell else self.plant.cells:
                task = self.plant.cells[name].task
                if task is not None:
                    self._store.attempted(task.id, task.attempts)

    def _keep_facts(self, facts: Sequence[Remember]) -> None:
        """Keep facts before what comes after them leaves; what need not be durable then is only noted."""
        if self._store is None or self._amnesia is not None:
            return
        if any(map(self.plant.precedes_commands, facts)):
            self._store.keep(*facts)
            self.durability.wrote(precedes_commands=True)
        else:
            self._settle()
            self._store.note(*facts)
            self._noted = True

    def _settle(self) -> None:
        """Commit what was noted."""
        if self._noted and self._store is not None and self._amnesia is None:
            self._noted = False
            self._store.settle()
            self.durability.wrote(precedes_commands=False)

    def _keep_task(self, change: TaskChanged) -> None:
        """Answer the requests for a task, and those who wait for its end, once it is kept."""
        if self._store is None:
            return
        known, unix_s = self.plant.intake.tasks.get(change.task), time.time()
        asked_by = self._asked_by.get(change.request or "", ROS)
        recipe, answers = (known.order.recipe, known.answers) if known else ("", [])
        self._store.task(change, recipe, unix_s, asked_by, answers)
        if change.state in ENDED:
            self._store.forget_tasks(unix_s - self.plant.model.history_days * DAY_S)
        self._wrote(change)

    def _wrote(self, *changes: Remember | Journal | TaskChanged) -> None:
        self.durability.wrote(precedes_commands=any(map(self.plant.precedes_commands, changes)))

    def _expect(self) -> tuple[Future[Any], str]:
        """A future, and the token of the request whose answer it will hold."""
        answer, token = Future[Any](), uuid4().hex
        self._waiting[token] = answer
        return answer, token

    def _answer(self, answer: Durable, unkept: Exception | None = None) -> None:
        self._asked_by.pop(answer.request or "", None)
        if isinstance(answer, OperatorAnswer):
            self.stops.closed(answer)
        waiting = self._waiting.pop(answer.request or "", None)
        if waiting is None:
            return
        if unkept is None:
            waiting.set_result(answer)
            return
        reply = self._unkept(answer, unkept) if isinstance(answer, OperatorAnswer) else answer
        if isinstance(reply, StopLeft):
            waiting.set_result(reply)
        else:
            waiting.set_exception(unkept)

    def _not_sent(self, message: Any, error: Exception) -> None:
        if isinstance(message, Facts | Journal | TaskChanged | CommandsLeft):
            self._forget(error)
            if isinstance(message, TaskChanged):
                self._answer(message, error)
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
        self.durability.wake()
        if self.recorder is not None:
            self.recorder.stepped(self.plant, now, events, messages)
        if self._amnesia is None:
            self.observers.tell(self.plant)
        if self.plant.intake.closed and self.plant.at_rest:
            self._at_rest.set()
        if self._showing is not None:
            self._show_on(now)
        if self._showing is not None:
            return
        version, shown_at = self._shown
        if version == self.plant.version and (now - shown_at < VIEW_S or not self._watched):
            return
        if self._show_at is None:
            self._show_at = max(now + SETTLE_S, self._show_after)
        if now < self._show_at and not self.plant.intake.closed:  # what is shown at the end may be the last
            self.loop.wake_by(self._show_at)
        else:
            self._show(now)

    @property
    def _watched(self) -> bool:
        """True if somebody wants to see the age of the displayed data."""
        return bool(self.watchers) or (self._ros is not None and self._ros.watched)

    @property
    def _waits_to_show(self) -> bool:
        """True while a snapshot is made of what is not durable yet."""
        return self.durability.durable < self._shown_from and self._amnesia is None

    def _show(self, now: float) -> None:
        self._shown, self._show_at = (self.plant.version, now), None
        self._showing = Slices(self._publication())
        self._show_on(now)

    def _show_on(self, now: float) -> None:
        """Show the next slice of the snapshot, or all that is left of it once the plant ends."""
        assert self._showing is not None
        waits = self._waits_to_show
        if (waits or now < self._showing.due) and not self.plant.intake.closed:
            self.loop.wake_by(now + SETTLE_S if waits else self._showing.due)
            return
        try:
            while not self._showing.cut(now) and self.plant.intake.closed:
                pass
        except Exception as error:  # noqa: BLE001 - a screen that cannot be drawn must not end the plant
            if repr(error) != self._blind:
                _log_defect("the screens", error)
            self._blind = repr(error)
        if self._showing.over:
            _, begun = self._shown
            self._show_after = begun + self._showing.spent_s / SHARE
            self._showing = None
        else:
            self.loop.wake_by(self._showing.due)

    def _publication(self) -> Generator[None, None, None]:
        """Make a snapshot and show it to all who watch, in parts between which the plant may be stepped."""
        snapshot = yield from view.in_parts(self.plant, self._resting.part)
        self._shown_from = self.durability.hurry()
        while self._waits_to_show and not self.plant.intake.closed:
            yield  # this slice ends soon, and the next one waits
        if self._amnesia is not None or not self.durability.reach(self._shown_from, READ_S):
            if not self._kept:
                return
            snapshot = self._last_kept
        before, self._kept = self._kept, snapshot
        if self.recorder is not None and not self.recorder.trouble:
            drawn = yield from twin_view.in_parts(self.plant)
            self.recorder.saw(snapshot, drawn)
        yield from self.watchers.telling(snapshot)
        if self._ros is not None:
            yield from self._ros.publish_view(snapshot)
            if self._ros.diagnosed:
                recorder = [] if self.recorder is None else [diagnostics.record(self.recorder.trouble)]
                found = (*diagnostics.diagnostics(snapshot), *recorder, *(each() for each in self.diagnoses))
                yield from self._ros.publish_diagnostics(found)
        rows = [row for kind in ("cells", "robots", "tasks") for row in before.get(kind, ())]
        del before
        while rows:  # to give back the memory of them all at once takes as long as some slices
            rows.pop()
            yield


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


def _gives_up(leave_out_raiser: Callable[[Exception], bool], error: Exception) -> bool:
    """True where a listener raised this because its package breaks; a defect of the runner is logged."""
    if leave_out_raiser(error):
        return True
    _log_defect("what is told of the plant", error)
    return False


def _log_defect(where: str, error: Exception) -> None:
    """Log a defect: one line for people, and the whole error with its traceback for the log file."""
    LOG.error("internal error in %s (%s: %s)", where, type(error).__name__, error)
    LOG.debug("the error in %s, whole", where, exc_info=error)


def task_line(change: TaskChanged) -> str:
    """The line on a change of a task."""
    why = f"  {change.sentence}" if change.sentence else ""
    return f"{change.state.value:<9} {change.text}{why}" + (
        f" ({change.reason.value})" if change.reason else ""
    )


def act_line(act: Journal) -> Sentence:
    """The line on an operator's act or its outcome, with the cell if no sentence names it."""
    return act.sentence if act.cell in (None, act.scope) else IN_CELL(did=act.sentence, cell=act.cell)


def _log(message: Durable) -> None:
    """Log each change of a task, and refusals; `change` is for screens that show it in colours, `sentence`
    for those that say it in another language."""
    if isinstance(message, RevisionAnswer):
        if message.refusal is not None:
            OPERATORS.warning("%s", message.refusal, extra={"sentence": message.refusal})
    elif isinstance(message, OperatorAnswer):
        if message.refusal is not None:
            line = VERB_REFUSED(verb=message.verb.value, scope=message.scope or "plant", why=message.refusal)
            OPERATORS.info("%s", line, extra={"sentence": line})
    elif message.state is TaskState.REFUSED:
        REQUESTS.warning("%s", task_line(message), extra={"change": message})
    else:
        level = logging.WARNING if message.state is TaskState.FAILED else logging.INFO
        TASKS.log(level, "%s", task_line(message), extra={"change": message})
