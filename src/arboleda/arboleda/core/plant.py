"""The plant: `Plant.step(now, events) -> commands and notices` is where all state changes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from itertools import filterfalse
from typing import Any

from py_trees.behaviour import Behaviour

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.fact_memory import Memory
from arboleda.dispatch.zones import Zones
from arboleda.model.commands import Command, Stop
from arboleda.model.errors import ArboledaError, IllegalTransition, QueueFull, TextError
from arboleda.model.messages import (
    Absence,
    CellRevised,
    Event,
    Fact,
    Failure,
    FaultByHand,
    Heartbeat,
    Interference,
    InternalError,
    Jog,
    Journal,
    KeptTask,
    LateDeparture,
    Notice,
    OperatorAnswer,
    OperatorRequest,
    Reason,
    Remember,
    Report,
    RestartRequest,
    Revision,
    RevisionAnswer,
    Shutdown,
    TaskChanged,
    TaskRequest,
    TaskState,
    Undelivered,
    outlives_power,
)
from arboleda.model.outside import plain, quoted
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.model.recipe import Builders
from arboleda.model.revision import Versions, obstacle, revised
from arboleda.model.sentence import OWN, Phrase, Sentence
from arboleda.model.task import Order, Task
from arboleda.trees.context import Context

from . import envelope, reasons
from .acts import OperatorAct
from .advice import Advice
from .advisor import Advisor
from .cell import CellRun, NextVersion
from .cell_states import CellState
from .cell_steps import advance
from .choosing import PastTimes, Prospect, best, prospect
from .earlier_start import look_back, trail_of, walk_back
from .intake import CUT_OFF, OTHER_VERSION, Intake, gone
from .operator import PUT_TO_WORK, RESTART_UNWANTED, RESTART_WANTED, Operator
from .provoked import ProvokedFaults
from .teaching import NOT_TAUGHT, OTHER_TEACHES, Teaching
from .verbs.scopes import NO_SCOPE, VerbRefusal

HEARTBEAT_S = 0.25
DEFECT = Phrase("plant.defect", "this failed on an internal error; the log has its details")
BROKE_IN_STEP = Phrase("cell.broke_in_step", "{cell}: {kind} in a step: {error}")
AWAY = Phrase("plant.away", "the plant was away for {seconds:.1f} s")
UNKNOWN_VERSION = Phrase("revision.unknown", "the plant has no version {number}")
NOT_WHILE_IT_RUNS = Phrase("revision.refused", "a plant that runs cannot take version {number}: {why}")
OWN_CYCLE = Phrase("cell.own_cycle", "{arm} is in its own cycle; its plant file refuses a trigger then")
# A plant steps at least as often as it beats. Boards stop by themselves after 1 s without a beat, so whoever
# was away for longer finds robots that stand, however long the plant file lets them be silent.
SHORTEST_ABSENCE_S, LONGEST_STALL_S = 1.0, 1.5
Request = TaskRequest | OperatorRequest
CHANGES_TOLD = 20  # in the journal; the version has all of them
SETTLES_IN = 3  # reports that say the same: by then it shows that a robot stands still
ROUND_BOUND = 100  # rounds over the cells in one step; more means cells that never leave each other in peace


class Plant:
    """All cells of a plant; `epoch` names this start and must be higher than any before.

    `memory` is what earlier starts had to keep: latches, effectors, zones that may be occupied; `kept` are
    their tasks in the order of acceptance: those that have not ended, and the last that have. `recipes` stand
    in for those of the cells; `versions` can be put to work while it runs, and whoever runs it may add to
    them. `next_deadline` is when `step` is due again without any event, s; a plant that is stepped more than
    `away_after_s` after its last step was away. `revisions`: by cell, a number that changes whenever anything
    that is told of it may have, but for times, the rate of reports, and what it shares.
    """

    def __init__(
        self,
        model: PlantModel,
        *,
        epoch: int,
        now: float,
        memory: Memory | None = None,
        kept: Iterable[KeptTask] = (),
        recipes: Builders | None = None,
        versions: Versions | None = None,
    ) -> None:
        memory = memory or {}
        self._builders = recipes or {}
        self.versions = {**(versions or {})}
        self._put_last = ""  # the digest of the version that was put to work last, in this start
        self.restart_by = ""  # who wants a restart once all cells rest
        self.model = model
        self.epoch = epoch
        self.now = now
        self._clock = partial(getattr, self, "now")  # the trees ask all the time: no call of Python's
        self.intake = Intake(model, epoch)
        self.dispatcher = Dispatcher(model, epoch, memory)
        if memory.get(Fact.QUARANTINE):
            for belief in self.dispatcher.beliefs.values():
                if belief.robot.goes:  # what it tells may be older than its last move of an earlier start
                    belief.doubt(until=now + SHORTEST_ABSENCE_S)
        self.zones = Zones((*model.zones, *model.shared), memory.get(Fact.QUARANTINE, {}))
        self.cells = {cell.name: self._run(cell) for cell in model.cells}
        self._operator = Operator(
            self.cells, self.dispatcher, self.zones, self.intake, self._clock, self._break_down
        )
        self.provoked = ProvokedFaults()
        self._advisor = Advisor(self.cells, self._operator.refusal)
        self._interlocked = [
            (run, device)
            for name, run in self.cells.items()
            for device in run.cell.interlocked
            if model.cell_of[device].name == name  # the first of the cells that share it
        ]
        self._to_home = {name for name, robot in model.robots.items() if robot.home_at_start}
        self._runs = {
            name: [self.cells[cell.name] for cell in cells] for name, cells in model.cells_of.items()
        }
        self._order = {name: number for number, name in enumerate(self.cells)}
        self._touched = set(self.cells)  # those to which something happened that they may wait for
        self.revisions = dict.fromkeys(self.cells, 0)
        self._revised: set[str] = set()  # in this step
        self._wakes: dict[str, float] = {}  # when trees are to be woken, by cell
        self._next_wake = math.inf
        self._changes = 0
        self._reported_errors: dict[str, Sentence] = {}  # by cell, since somebody asked for something
        self._next_beat = now
        self._steps = False
        self._take_back(kept)
        self._end_taught_before()
        self.away_after_s = min(max(model.timing.stale_after_s, SHORTEST_ABSENCE_S), LONGEST_STALL_S)
        self.next_deadline = now

    def step(self, now: float, events: Iterable[Event]) -> list[Command | Notice]:
        """Take in `events` in order, then deadlines up to `now` (s, never decreasing); what must go out."""
        events, away_s = [*events], now - self.now
        if LateDeparture in map(type, events):
            events = self._without_late_departures(events)
        if self._steps and away_s > self.away_after_s:
            self._come_back(away_s)
            events = _requests_last(events, now)
        self.now, self._steps = now, True
        for event in events:
            if event.at > self.next_deadline:
                self._expire(math.nextafter(event.at, -math.inf))
            if isinstance(event, Report):
                self._on_report(event)
            else:
                for name in self._touched:  # whoever asks finds judged what was heard before
                    self._guard(name, partial(look_back, self.cells[name]))
                if not isinstance(
                    event, TaskRequest | Jog
                ):  # that is the business of the cell which takes it
                    self._touched.update(self.cells)
                    self._revised.update(self.cells)
                self._reported_errors.clear()
                HANDLERS[type(event)](self, event)
        self._expire(now)
        if self._interlocked:
            self._watch_interlocks()
        if self.zones.is_used:
            self._watch_zones()
        self._advance()
        if self._operator.acts.under_way:
            self._changes += self._operator.look()
            self._revised.update(self.cells)
        for name in self._revised:
            self.revisions[name] += 1
        self._revised.clear()
        self._beat()
        self.next_deadline = self._earliest()
        out = self.dispatcher.outbox.copy()
        self.dispatcher.outbox.clear()
        return out

    def _without_late_departures(self, events: list[Event]) -> list[Event]:
        """The other events: what left late is due later, whatever was heard meanwhile."""
        for event in events:
            if isinstance(event, LateDeparture):
                self.dispatcher.left_late(event.id, event.late_s)
        self.next_deadline = self._earliest()
        return [event for event in events if not isinstance(event, LateDeparture)]

    def precedes_commands(self, kept: Remember | Journal | TaskChanged) -> bool:
        """True for what has to be durable before a command leaves; not for effectors in an envelope.

        Of a task that is its begin, with which its envelope is kept: what comes later is durable after that,
        and who asked for it, or waits for its end, is told once it is.
        """
        if isinstance(kept, TaskChanged):
            return kept.state is TaskState.RUNNING
        if not outlives_power(kept):
            return False
        if not isinstance(kept, Remember) or kept.fact is not Fact.EFFECTOR:
            return True
        return not any(kept.name in envelope.of_task(run) for run in self._runs.get(kept.name, ()))

    @property
    def version(self) -> int:
        """A number that changes whenever something other than a position changed."""
        return self.dispatcher.ledger.version + self.dispatcher.effectors.version + self._changes

    @property
    def acts(self) -> Sequence[OperatorAct]:
        """The last acts of operators, oldest first."""
        return self._operator.acts.last

    def advice(self, cell: str) -> tuple[Advice, ...]:
        """Advice that leads a cell out of its present state, in the order to do it; none where it works."""
        return self._advisor.advice(cell)

    def refusal(self, request: OperatorRequest) -> Sentence | None:
        """Why a request of an operator would be refused now; None where it would be done."""
        return self._operator.refusal(request)

    def jog_refusal(self, jog: Jog) -> Sentence | None:
        """Why nothing would move, were this button pressed now; None where something would."""
        run = self.cells.get(jog.cell)
        if run is None:
            return NO_SCOPE(scope=quoted(jog.cell), known=(*self.cells,))
        if run.manual.teaching is None:
            return NOT_TAUGHT(cell=jog.cell)
        if run.manual.teaching.session != jog.session:
            return OTHER_TEACHES(cell=jog.cell, teacher=run.manual.teaching.teacher)
        return run.manual.teaching.refusal(jog)

    def prospects(self, text: str) -> list[Prospect]:
        """The promise of each cell that a task text names; TextError or QueueFull where there is none."""
        return self._prospects(self.intake.orders(text))

    @property
    def at_rest(self) -> bool:
        """True where no command is open and no task runs, but for those that are left for the next start."""
        runs = self.cells.values()
        ended = all(run.tree is None or (run.closed and run.state is CellState.HELD) for run in runs)
        return not self.dispatcher.ledger.entries and ended

    @property
    def may_restart(self) -> bool:
        """True where a restart is wanted, and it would cut nothing short: no task, command or teaching."""
        return (
            self.restart_by != ""
            and self.at_rest
            and not any(run.manual.teaching for run in self.cells.values())
        )

    def sleepers(self) -> list[str]:
        """Cells whose tree runs with nothing left to wake it; anything here is a defect."""
        awake = {entry.cell for entry in self.dispatcher.ledger.entries.values()}
        runs = [cell for cell in self.cells.values() if cell.tree and cell.state is CellState.EXECUTE]
        asleep = [cell.cell.name for cell in runs if not cell.context.time.wakes]
        return [name for name in asleep if name not in awake]

    def _run(self, cell: Cell) -> CellRun:
        context = Context(cell, self.dispatcher, self.zones, self._clock, self._at_work)
        stop = None
        if self._was_stopped(cell, self.dispatcher.latches.stopped):
            stop = CellState.ABORTED
        elif self._was_stopped(cell, self.dispatcher.latches.cleared):
            stop = CellState.STOPPED
        return CellRun(cell, context, self._task_changed, self._build, self._ways_out, stop)

    def _take_back(self, kept: Iterable[KeptTask]) -> None:
        """Queue again what waited when an earlier start ended, and hold what was at work then at its step."""
        tasks = [(each.state, self.intake.take_back(each, self.now)) for each in kept]
        for name, run in self.cells.items():
            own = [task for _, task in tasks if task.order.cell == name]
            waiting = [task for task in own if task.state is TaskState.QUEUED]
            at_work = [task for task in own if task.state is TaskState.RUNNING]
            run.queue.take_back(waiting, cut_off=bool(at_work))
            for task in at_work:
                trail = self.dispatcher.memory.value(Fact.STEP, task.id)
                if trail is not None and run.task is None and run.state is CellState.IDLE:
                    walk_back(run, task, trail)
        known = {run.task for run in self.cells.values()}
        for was, task in tasks:
            if task.state is TaskState.RUNNING and task not in known:
                task.fail(Failure(reason=Reason.INTERRUPTED, sentence=CUT_OFF()))
                task.become(TaskState.FAILED, self.now)
            if task.state is not was:
                self._task_changed(task)
        for id in self.dispatcher.memory.names(Fact.STEP) - {task.id for task in known if task}:
            self.dispatcher.memory.remember(Fact.STEP, id, None)
        held = (run for run in self.cells.values() if run.task is not None)
        self._to_home -= {robot.name for run in held for robot in run.cell.robots}

    def _end_taught_before(self) -> None:
        """A cell that was being taught when an earlier start ended begins nothing by itself: somebody may
        stand beside it.
        """
        for name in sorted(self.dispatcher.memory.names(Fact.MANUAL)):
            self.dispatcher.memory.remember(Fact.MANUAL, name, None)
            if name in self.cells:
                self.cells[name].queue.paused = True

    def _was_stopped(self, cell: Cell, stopped: set[str]) -> bool:
        """True for a cell that had been stopped: one of its own robots was, or what it shares, by itself."""
        if not stopped.isdisjoint(cell.own):
            return True
        for name in stopped.intersection(cell.shared):
            if all(stopped.isdisjoint(other.own) for other in self.model.cells_of[name]):
                return True
        return False

    def _at_work(self, holder: str) -> bool:
        """True where the work of a robot, or a cell, comes to an end by itself."""
        cell = self.cells.get(self.zones.holder(holder) or holder)  # of a shared robot that which has it
        if cell is not None:
            return cell.state is CellState.EXECUTE
        executes = any(run.state is CellState.EXECUTE for run in self._runs.get(holder, ()))
        return executes or bool(self.dispatcher.ledger.of_robot(holder))

    def _ways_out(self, cell: str) -> tuple[Advice, ...]:
        return self._advisor.ways_out(cell)

    def _build(self, order: Order, context: Context) -> Behaviour:
        build = self._builders.get(order.recipe) or context.cell.recipe(order.recipe).build
        return build(order, context)

    def _task_changed(self, task: Task, request: str | None = None) -> None:
        self._changes += 1
        sentence = reasons.of_waiting(self.cells[task.order.cell]) if task.state is TaskState.QUEUED else None
        change = TaskChanged(
            task=task.id,
            text=task.order.text,
            cell=task.order.cell,
            state=task.state,
            reason=task.failure.reason if task.failure else None,
            sentence=sentence or task.remark,
            request=request,
            choice=task.choice,
            course=task.course,
            unchecked=task.unchecked,
        )
        self.dispatcher.outbox.append(change)
        if task.ended_at is not None:
            self.dispatcher.memory.remember(Fact.STEP, task.id, None)

    def _expire(self, limit: float) -> None:
        if limit >= self.next_deadline:
            self.dispatcher.expire(limit, self.now, self._guard)

    def _earliest(self) -> float:
        return min(self._next_beat, self._next_wake, self.dispatcher.next_deadline)

    def _advance(self) -> None:
        """Let the cells to which something happened do what they can, again while that makes them do more."""
        ledger = self.dispatcher.ledger
        soon = math.nextafter(self.now, math.inf)  # after a hold, rounding may bring a wake so much earlier
        if self._next_wake <= soon:
            woken = [name for name, at in self._wakes.items() if at <= soon]
            self._touched.update(woken)
            self._revised.update(woken)
        if not self._touched and not ledger.changed:
            return
        touched, self._touched = self._touched, set()
        for _ in range(ROUND_BOUND):
            changed, ledger.changed = ledger.changed, set()
            touched |= changed
            in_order = sorted(touched, key=self._order.__getitem__)
            did = set[str]()
            for name in in_order:
                if self._advanced(name, woken=name in changed):
                    did.add(name)
            self._revised |= changed | did
            self._plan(touched)
            if did:
                self._changes += 1
                self._watch_shared()
            elif not ledger.changed:
                return
            touched = did
        for name in sorted(touched, key=self._order.__getitem__):
            restless = f"the cells do not come to rest in {ROUND_BOUND} rounds of one step"
            self._break_down(name, ArboledaError(restless))

    def _advanced(self, name: str, *, woken: bool) -> bool:
        """Let a cell do what it can; whether it did."""
        before = len(self.dispatcher.outbox)
        try:
            did = advance(self.cells[name], woken=woken)
            if did or woken:
                self._keep_trail(self.cells[name], before)
        except Exception as error:  # noqa: BLE001 - whatever it is, it ends the work of this cell, not the plant
            self._break_down(name, error)
            return False
        return did

    def _keep_trail(self, run: CellRun, before: int) -> None:
        """Have it kept where a cell's task stands, before any command of what is newer in the outbox leaves,
        and before anybody hears that the task runs.

        It says of steps that they are done, so what those have left behind is kept before it.
        """
        text = trail_of(run)
        if text is None or run.task is None:
            return
        outbox = self.dispatcher.outbox
        first = before
        while first < len(outbox) and not _waits(outbox[first], run.task):
            first += 1
        facts, others = list[Command | Notice](), list[Command | Notice]()
        for each in outbox[first:]:
            (facts if _is_fact(each) else others).append(each)
        outbox[first:] = facts
        self.dispatcher.memory.remember(Fact.STEP, run.task.id, text)
        outbox += others

    def _guard(self, cell: str, act: Callable[[], None]) -> None:
        """Do something that belongs to one cell; what it raises holds that cell, and nothing else."""
        try:
            act()
        except Exception as error:  # noqa: BLE001 - whatever it is, it ends the work of this cell, not the plant
            self._break_down(cell, error)

    def _break_down(self, cell: str, error: Exception) -> None:
        """Hold a cell in which something raised; the error is told whole, once until somebody acts."""
        self._changes += 1
        self._revised.add(cell)
        text = plain(" ".join(str(error).split()))
        sentence = BROKE_IN_STEP(cell=cell, kind=type(error).__name__, error=text)
        failure = Failure(reason=Reason.INTERNAL, sentence=sentence)
        if self._reported_errors.get(cell) != sentence:
            self._reported_errors[cell] = sentence
            self.dispatcher.outbox.append(InternalError(cell=cell, error=error))
        self.dispatcher.booking.give_up(cell, failure, self.now)
        self.cells[cell].break_down(failure)

    def _plan(self, names: Iterable[str]) -> None:
        """Take over when the trees of these cells are to be woken."""
        for name in names:
            at = self.cells[name].due
            self._wakes[name] = math.inf if at is None else at
        self._next_wake = min(self._wakes.values())

    def _come_back(self, away_s: float) -> None:
        """Hold what was at work when the plant fell silent.

        Robots have stopped themselves meanwhile, and people may have gone near them. So nothing that was
        under way moves before an operator says so, and the time away does not pass for the trees.
        """
        left, self.now = self.now, self.now + away_s
        failure = Failure(reason=Reason.LINK_LOST, sentence=AWAY(seconds=away_s))
        self.dispatcher.outbox.append(Absence(seconds=away_s))
        self._to_home.clear()
        self._touched.update(self.cells)
        self._revised.update(self.cells)
        self._changes += 1
        for name, cell in self.cells.items():
            if cell.state is CellState.EXECUTE:
                cell.context.time.pause(at=left)
            self._guard(name, partial(cell.outlast, failure))

    def _watch_interlocks(self) -> None:
        for run, device in self._interlocked:
            self._guard(run.cell.name, partial(run.context.zones.follow, device))

    def _watch_zones(self) -> None:
        inside = self.zones.robots
        for name, cell in self.cells.items() if inside else ():
            # One that cells share may have homed for a cell without zones, and held those of another.
            movers = filter(cell.context.devices.answers_for, cell.cell.workspaces)
            machines = filterfalse(cell.context.devices.is_lent, cell.cell.interlocked)
            for robot in (*movers, *machines):
                if robot in inside:
                    self._guard(name, partial(self._watch_zones_of, cell, robot))
        self._watch_shared()

    def _watch_shared(self) -> None:
        """Give back the shared devices that an idle cell still holds; it keeps those that are silent."""
        for device in self.model.shared:
            holder = self.cells.get(self.zones.holder(device) or "")
            if holder is not None:
                # a cell that is held, stopped or taught keeps what it has
                ended = holder.state is CellState.IDLE and holder.manual.teaching is None
                self._guard(holder.cell.name, partial(holder.context.devices.keep, device, ended=ended))

    def _watch_zones_of(self, cell: CellRun, robot: str) -> None:
        """A robot that is not heard may still be where it was; one that is seen outside is not."""
        belief = self.dispatcher.beliefs[robot]
        if not belief.online or belief.unhomed:
            self.zones.quarantine(robot)
        elif cell.manual.teaching is None and (
            cell.tree is None or cell.stranded
        ):  # no step of it needs them any more
            cell.context.zones.leave(robot)

    def _beat(self) -> None:
        if self.now >= self._next_beat:
            self._next_beat = self.now + HEARTBEAT_S
            self.dispatcher.outbox.append(Heartbeat(epoch=self.epoch))

    def _on_report(self, report: Report) -> None:
        runs = self._runs.get(report.robot)
        if runs is None:
            return
        try:
            before = self.dispatcher.effectors.version
            self.dispatcher.report(report, self.now)
            is_news = self.dispatcher.beliefs[report.robot].repeats < SETTLES_IN
            is_news = is_news or self.dispatcher.effectors.version != before
            for run in runs:
                if is_news or run.state is not CellState.IDLE:
                    self._revised.add(run.cell.name)
                    if run.state is not CellState.EXECUTE:  # what such a cell waits for shows in reports
                        self._touched.add(run.cell.name)
                if report.piece is not None and run.context.sensors.awaited:
                    run.context.sensors.awaited = False  # who goes on waiting asks again
                    self.dispatcher.ledger.changed.add(run.cell.name)
            if report.robot in self._to_home:
                self._home_at_start(report.robot)
        except Exception as error:  # noqa: BLE001 - whatever it is, it ends the work of this cell, not the plant
            self._break_down(runs[0].cell.name, error)

    def _home_at_start(self, robot: str) -> None:
        belief = self.dispatcher.beliefs[robot]
        self._revised.update(run.cell.name for run in self._runs[robot])
        if not belief.answered or belief.homed is None:
            return
        run = self._operator.scopes.in_charge(robot)
        if run.state not in (CellState.IDLE, CellState.HELD) or run.manual.teaching is not None:
            return
        if belief.unhomed and self._operator.homing.not_free(frozenset([robot])):
            return
        self._to_home.discard(robot)
        if belief.unhomed:
            self._operator.homing.home(robot)

    def _on_undelivered(self, event: Undelivered) -> None:
        cell = self.model.cell_of.get(event.robot)
        if cell is not None:
            fail = self.dispatcher.booking.undelivered
            self._guard(cell.name, partial(fail, event.id, event.robot, event.sentence, self.now))

    def _on_interference(self, event: Interference) -> None:
        if event.robot in self.dispatcher.beliefs:
            self.dispatcher.interfere(event.robot, event.sentence, event.at, obeyed=True)

    def _on_fault_by_hand(self, event: FaultByHand) -> None:
        self._changes += 1
        self.provoked.note(event)
        cell = next((cell.name for cell in self.model.cells_of.get(event.robot, ())), None)
        entry = Journal(verb=None, scope=event.robot, cell=cell, sentence=event.sentence)
        self.dispatcher.outbox.append(entry)

    def _on_task_request(self, request: TaskRequest) -> None:
        try:
            if request.kept is not None:
                self.intake.recall(request.kept)
            task = self.intake.task(request.text, lambda orders: best(self._prospects(orders)))
            if not self.intake.knows(task):
                if request.version and self._put_last not in ("", request.version):
                    raise TextError(OTHER_VERSION())
                task.version = request.version
                if request.choice and task.choice is None:
                    task.choice = OWN(text=plain(request.choice))
                self._refuse_trigger(request, task)
                self.cells[task.order.cell].queue.add(task)
                self._touched.add(task.order.cell)
                self._revised.add(task.order.cell)
                self.intake.remember(task)
        except (TextError, QueueFull) as refusal:
            for_now = isinstance(refusal, QueueFull)
            self.dispatcher.outbox.append(_refused(request, refusal.sentence, for_now=for_now))
            return
        except Exception as error:  # noqa: BLE001 - whoever asks gets an answer, and the plant goes on
            self.dispatcher.outbox += [_refused(request, DEFECT()), InternalError(cell="", error=error)]
            return
        self._task_changed(task, request.request)

    def _prospects(self, orders: Iterable[Order]) -> list[Prospect]:
        """The promises of the cells that may carry out one of these orders."""
        times = PastTimes(self.intake.tasks.values())
        return [prospect(order, self.cells[order.cell], times, self.now) for order in orders]

    def _refuse_trigger(self, request: TaskRequest, task: Task) -> None:
        """Raise QueueFull for a machine's start signal that the cell does not take now."""
        cell = self.cells[task.order.cell]
        busy = cell.queue.in_its_own_cycle(cell.task) if request.trigger else None
        if busy is not None:
            raise QueueFull(OWN_CYCLE(arm=busy))

    def _on_operator_request(self, request: OperatorRequest) -> None:
        self._changes += 1
        refusal, before, act = None, len(self.dispatcher.outbox), None
        try:
            act = self._operator.act(request)
            for run in self.cells.values():
                self._keep_trail(run, before)
        except (VerbRefusal, IllegalTransition) as error:
            refusal = error.sentence
        except Exception as error:  # noqa: BLE001 - whoever asks gets an answer, and the plant goes on
            refusal = DEFECT()
            self.dispatcher.outbox.append(InternalError(cell="", error=error))
        answer = OperatorAnswer(
            verb=request.verb,
            scope=request.scope,
            arguments=request.arguments,
            refusal=refusal,
            request=request.request,
            act=act.number if act else None,
            outcome=act.outcome if act else None,
            why=act.why if act else None,
        )
        self.dispatcher.outbox.append(answer)

    def _on_jog(self, jog: Jog) -> None:
        """Take what a teacher holds; what is of no teaching, or of an earlier one, is nothing."""
        run = self.cells.get(jog.cell)
        if run is None or run.manual.teaching is None or run.manual.teaching.session != jog.session:
            return
        self._guard(jog.cell, partial(self._take_jog, run, run.manual.teaching, jog))

    def _take_jog(self, run: CellRun, teaching: Teaching, jog: Jog) -> None:
        self._touched.add(jog.cell)
        if teaching.take(jog):
            self._changes += 1
            self._revised.add(jog.cell)

    def _on_revision(self, event: Revision) -> None:
        """Have each cell take another version once it rests; what waits is held against it at once."""
        self._changes += 1
        version, number = event.version, event.version.number
        model = self.versions.get(version.digest)
        if model is None:
            self._refuse_revision(event, UNKNOWN_VERSION(number=number))
            return
        if (why := obstacle(self.model, model)) is not None:
            self._refuse_revision(event, NOT_WHILE_IT_RUNS(number=number, why=why))
            return
        cells = tuple(map(revised, self.model.cells, model.cells))
        self._put_last = version.digest
        self.dispatcher.outbox.append(_put_to_work(event))
        self.intake.model = replace(model, cells=cells)
        cancelled = [id for run in self.cells.values() for id in self._without_unfit(run, version.digest)]
        for run, cell in zip(self.cells.values(), cells, strict=True):
            run.following = NextVersion(
                version=version, cell=cell, timing=model.timing, taken=self._revised_cell
            )
        self._use(replace(self.intake.model, cells=self.model.cells))
        busy = [(name, run) for name, run in self.cells.items() if not run.is_between_tasks]
        waits = tuple((name, run.task.id if run.task else "") for name, run in busy)
        self.dispatcher.outbox.append(
            RevisionAnswer(version=version, waits=waits, cancelled=tuple(cancelled), request=event.request)
        )

    def _refuse_revision(self, event: Revision, why: Sentence) -> None:
        self.dispatcher.outbox.append(
            RevisionAnswer(version=event.version, refusal=why, request=event.request)
        )

    def _without_unfit(self, run: CellRun, version: str) -> list[str]:
        """Read again what waits in a cell for this version; the ids of those that end by it."""
        unfit = []
        for task in [*run.queue]:
            try:
                task.order = self.intake.still_allowed(task, version)
            except TextError as error:
                unfit.append(task.id)
                run.drop(task, gone(error.sentence))
        return unfit

    def _revised_cell(self, taken: NextVersion) -> None:
        """Go by another version of a cell, which it has taken now."""
        name = taken.cell.name
        cells = tuple(taken.cell if cell.name == name else cell for cell in self.model.cells)
        self._use(replace(self.model, cells=cells))
        self._revised.add(name)
        self._changes += 1
        self.dispatcher.outbox.append(CellRevised(cell=name, version=taken.version))

    def _use(self, model: PlantModel) -> None:
        self.model = self.dispatcher.model = model

    def _on_restart_request(self, event: RestartRequest) -> None:
        by = plain(event.by) or "-"
        self.restart_by = by if event.wanted else ""
        self._changes += 1
        for cell in self.cells.values():
            cell.awaits_restart, cell.dirty = event.wanted, True
        did = RESTART_WANTED if event.wanted else RESTART_UNWANTED
        self.dispatcher.outbox.append(Journal(verb=None, scope="", cell=None, sentence=did(by=by)))

    def _on_shutdown(self, event: Shutdown) -> None:
        self.intake.closed = True
        self._changes += 1  # a cell may be held by it that had told nobody anything
        for name, cell in self.cells.items():
            self._guard(name, partial(cell.close, drops_waiting=event.drops_waiting))


def _requests_last(events: Iterable[Event], now: float) -> list[Event]:
    """The events that a plant finds which was away, with requests of people as if they asked now.

    They ask for it of robots as they are now, so the plant hears first what those have said since.
    """
    found = list(events)
    requests = [each for each in found if isinstance(each, Request)]
    news = [each for each in found if not isinstance(each, Request)]
    return [*news, *(replace(request, at=now) for request in requests)]


def _put_to_work(event: Revision) -> Journal:
    """The entry of the journal about a version that is put to work."""
    lines = tuple(map(plain, event.changes[:CHANGES_TOLD]))
    left = len(event.changes) - len(lines)
    changes = (*lines, *((f"... ({left})",) if left else ())) or ("-",)
    by = plain(event.by) or "-"
    sentence = PUT_TO_WORK(number=event.version.number, by=by, changes=changes)
    return Journal(verb=None, scope="", cell=None, sentence=sentence)


def _waits(message: Command | Notice, task: Task) -> bool:
    """True for a command, and for the word that a task runs."""
    if isinstance(message, TaskChanged):
        return message.task == task.id and message.state is TaskState.RUNNING
    return isinstance(message, Command) and not isinstance(message, Stop)


def _is_fact(message: Command | Notice) -> bool:
    """True for a fact, but for that a task stands nowhere any more: that is told after its end."""
    return isinstance(message, Remember) and not (message.fact is Fact.STEP and message.value is None)


def _refused(request: TaskRequest, sentence: Sentence, *, for_now: bool = False) -> TaskChanged:
    return TaskChanged(
        task="",
        text=plain(request.text),
        cell=None,
        state=TaskState.REFUSED,
        sentence=sentence,
        request=request.request,
        for_now=for_now,
    )


HANDLERS: dict[type, Callable[[Plant, Any], None]] = {
    TaskRequest: Plant._on_task_request,
    OperatorRequest: Plant._on_operator_request,
    Jog: Plant._on_jog,
    Undelivered: Plant._on_undelivered,
    Interference: Plant._on_interference,
    FaultByHand: Plant._on_fault_by_hand,
    Shutdown: Plant._on_shutdown,
    Revision: Plant._on_revision,
    RestartRequest: Plant._on_restart_request,
}
