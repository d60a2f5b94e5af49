"""The plant: `Plant.step(now, events) -> commands and notices` is where all state changes.

**Theory of operation.** A plant has no clock, no thread and no I/O. A process (`runtime/`), the simulator or
a test hands it what has happened, each event with its time, and carries out what it returns. A plant that is
made the same, with the same events at the same times, gives the same: so a record can be run again.

A step has these phases, in this order:

1. *Late departures.* A command that left late is due later. This precedes all that looks at deadlines.
2. *Absence.* After more than `away_after_s` without a step, robots may have stopped by themselves, and people
   may have gone near them. So cells at work are held before any event is taken in, unless the plant file lets
   them go on. Tasks and verbs are taken last, as if they were asked now: people mean the robots as they are.
3. *Events*, in order. Before each one the deadlines expire that came earlier, so in a late step a command
   fails or succeeds as in a punctual one. A report changes what is believed of a device, and ends commands by
   evidence. All other events are judged by the reports before them; each request has its answer in this step.
   Events mark the cells that may have waited for them in `News`.
4. *Deadlines* up to now, which no event has settled: commands that are late, robots that are silent.
5. *Zones* follow what was heard: a robot that is seen outside gives its zone back, one whose place is unknown
   keeps it as quarantined. This precedes the trees, which ask for zones by all that was heard.
6. *Rounds.* Each cell that is marked, woken by its time, or whose command has ended does what it can: it
   leaves a state that waits, ticks its tree, starts its next task. One cell may give another more to do, with
   a zone or a shared device. So rounds go on until no cell does anything. Trees send their commands here.
7. *Acts.* Where this step has shown how an operator's act ended, the journal says so.
8. *Heartbeat.* Robots that hear none stop by themselves. It comes last, so a step that hangs sends none.

Commands and notices are returned in the order in which they arose. Not all may leave alike:

- A stop waits for nothing: it leaves before anything of its step is kept. While a step is at work, the
  process sends it beside the step (`departures/stop_lane.py`); the plant gives it again in its next step.
- Any other command leaves once all notices for which `precedes_commands` is true are durable: a latch, a task
  that begins. Other notices become durable behind the commands.
- People are told of a notice once it is durable.

What raises while it works for a cell ends the work of that cell, not that of the plant (`CellGuard`). What
the parts of a plant share is in `PlantState`: beliefs, open commands and facts of earlier starts in
`Dispatcher`, tasks by their ids in `Intake`, zones and who holds them in `Zones`. `CellRun` is one cell, with
its queue, task and tree; it changes its state by a table alone.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from py_trees.behaviour import Behaviour

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.fact_memory import Memory
from arboleda.dispatch.lateness import LATE_S
from arboleda.dispatch.zones import Zones
from arboleda.model.advice import Advice
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Command
from arboleda.model.messages import (
    Absence,
    ClockSet,
    Event,
    Fact,
    Failure,
    FaultByHand,
    Heartbeat,
    Interference,
    Jog,
    Journal,
    KeptTask,
    LateDeparture,
    Notice,
    OperatorRequest,
    Reason,
    Remember,
    Report,
    RestartRequest,
    Revision,
    Shutdown,
    TaskChanged,
    TaskRequest,
    TaskState,
    Uncontested,
    Undelivered,
    outlives_power,
)
from arboleda.model.outside import plain
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.model.recipe import Builders
from arboleda.model.revision import Versions
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.task import Order
from arboleda.trees.context import Context

from . import envelope
from .acts import OperatorAct, ProvokedFaults
from .advisor import Advisor
from .cell import CellRun
from .cell_guard import CellGuard
from .cell_steps import outlast
from .choosing import Prospect
from .earlier_start import end_teaching, look_back, stop_of
from .intake import Intake
from .news import News
from .operator import CLOCK_AHEAD, CLOCK_BACK, RESTART_UNWANTED, RESTART_WANTED, Operator
from .people import People
from .plant_state import PlantState
from .revisions import Revisions
from .rounds import Rounds
from .task_desk import TaskDesk
from .verbs.homing import HomingAtStart
from .zone_watch import ZoneWatch

HEARTBEAT_S = 0.25
AWAY = Phrase("plant.away", "the plant was away for {seconds:.1f} s")
"""Reason of a hold after the plant's thread has stood still."""
# A plant steps at least at each heartbeat. Boards stop by themselves after 1 s without one. So a
# plant that was away for longer finds robots that stand, however long its file lets robots be silent.
SHORTEST_ABSENCE_S, LONGEST_STALL_S = 1.0, 1.5
Request = TaskRequest | OperatorRequest
SETTLES_IN = 3  # equal reports in a row, by which a robot is seen to stand still


class Plant:
    """All cells of a plant. `epoch` names this start of the plant, and is higher than that of all before.

    `memory` has the facts of earlier starts: latches, effectors, zones that may be occupied. `kept` has the
    tasks of earlier starts in the order of acceptance: all that have not ended, and the last that have.
    `recipes` replace the cells' recipes by name. `versions` are models that can be put to work while the
    plant runs; the process that runs it may add some. A plant was away if its last step was more than
    `away_after_s` ago. `revisions` has a number by cell, which grows whenever the cell's view may change, but
    for times, rates and shared devices.
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
        self.versions = {**(versions or {})}
        self.restart_by = ""  # the person who wants a restart once all cells rest
        self.model = model
        self.epoch = epoch
        self.now = now
        dispatcher = Dispatcher(model, epoch, memory)
        if memory.get(Fact.QUARANTINE):
            _doubt_stillness(dispatcher, until=now + SHORTEST_ABSENCE_S)
        self.revisions = {cell.name: 0 for cell in model.cells}
        state = PlantState(
            clock=self,
            dispatcher=dispatcher,
            zones=Zones((*model.zones, *model.shared), memory.get(Fact.QUARANTINE, {})),
            intake=Intake(model, epoch),
            news=News(self.revisions),
        )
        self.dispatcher, self.zones, self.intake = dispatcher, state.zones, state.intake
        self._news = news = state.news
        self._tasks = TaskDesk(state)
        self.cells = state.cells
        self.cells |= {cell.name: self._run(cell, recipes or {}) for cell in model.cells}
        self._guard = guard = CellGuard(state)
        self._operator = Operator(state, guard.break_down)
        self.provoked = ProvokedFaults()
        self._advisor = Advisor(state, self._operator.refusal)
        self._watch = ZoneWatch(state, guard)
        self._rounds = Rounds(state, guard, self._watch)
        self._people = People(state, self._operator, guard, self._rounds)
        revisions = Revisions(state, self.versions, self._use)
        self._runs = {
            name: [self.cells[cell.name] for cell in cells] for name, cells in model.cells_of.items()
        }
        self._next_beat = now
        self._steps = False
        self._tasks.take_back(kept)
        end_teaching(self.cells, dispatcher.memory)
        self._first_homing = HomingAtStart(state, self._operator.scopes, self._operator.homing)
        self._handlers: dict[type, Callable[[Any], None]] = {
            TaskRequest: self._tasks.take,
            OperatorRequest: self._people.operate,
            Jog: self._people.jog,
            Undelivered: self._on_undelivered,
            Interference: self._on_interference,
            Uncontested: lambda event: dispatcher.believe_again(event.robot, event.said),
            FaultByHand: self._on_fault_by_hand,
            ClockSet: partial(_note_clock, news, self.provoked, dispatcher.outbox),
            Shutdown: self._on_shutdown,
            Revision: revisions.take,
            RestartRequest: self._on_restart_request,
        }
        self.away_after_s = min(max(model.timing.stale_after_s, SHORTEST_ABSENCE_S), LONGEST_STALL_S)
        self._due: float | None = now  # None after a step, until it is worked out

    @property
    def next_deadline(self) -> float:
        """The time at which `step` is due without an event, s; worked out when it is asked for."""
        if self._due is None:
            self._due = min(self._next_beat, self._rounds.next_wake, self.dispatcher.next_deadline)
        return self._due

    def step(self, now: float, events: Iterable[Event]) -> list[Command | Notice]:
        """Take in `events` in order, then deadlines up to `now` (s, never decreasing); return what to send.

        The module says its phases; the numbers are those there.
        """
        events, away_s = [*events], now - self.now
        if LateDeparture in map(type, events):  # 1
            events = self._without_late_departures(events)
        due = self.next_deadline if self._due is None else self._due
        if self._steps and away_s > self.away_after_s:  # 2
            self._come_back(away_s)
            events = _requests_last(events, now)
        if (pause_s := now - self._next_beat + HEARTBEAT_S) > LATE_S:
            self.dispatcher.beat_pauses.note(now, pause_s)
        self.now, self._steps = now, True
        for event in events:  # 3
            if event.at > due:
                limit = math.nextafter(event.at, -math.inf)  # a report that comes at a deadline is in time
                if limit >= due:
                    self.dispatcher.expire(limit, now, self._guard.run)
            if isinstance(event, Report):
                self._on_report(event)
            else:
                for name in self._news.touched:  # a request meets tasks as the reports before it judge them
                    self._guard.run(name, partial(look_back, self.cells[name]))
                if not isinstance(event, TaskRequest | Jog):  # those touch the cell that takes them alone
                    self._news.touched.update(self.cells)
                    self._news.revised.update(self.cells)
                self._guard.told.clear()
                self._handlers[type(event)](event)
        if now >= due:  # 4
            self.dispatcher.expire(now, now, self._guard.run)
        if self._watch.interlocked:  # 5
            self._watch.follow_interlocks()
        if self.zones.is_used:
            self._watch.look()
        self._rounds.go(now)  # 6
        if self._operator.acts.under_way:  # 7
            self._news.changes += self._operator.look()
            self._news.revised.update(self.cells)
        for name in self._news.revised:
            self.revisions[name] += 1
        self._news.revised.clear()
        if now >= self._next_beat:  # 8
            self._next_beat = now + HEARTBEAT_S
            self.dispatcher.outbox.append(Heartbeat(epoch=self.epoch))
        self._due = None
        out = self.dispatcher.outbox.copy()
        self.dispatcher.outbox.clear()
        return out

    def _without_late_departures(self, events: list[Event]) -> list[Event]:
        """The other events. A command that left late is due later, before any deadline is looked at."""
        for event in events:
            if isinstance(event, LateDeparture):
                self.dispatcher.left_late(event.id, event.late_s)
        self._due = None
        return [event for event in events if not isinstance(event, LateDeparture)]

    def precedes_commands(self, notice: Remember | Journal | TaskChanged) -> bool:
        """True for a notice that has to be durable before any command leaves.

        Of a task only its begin precedes: its envelope is kept then. An effector of the envelope does not
        precede, since after a power cut it does not count as off anyway. People hear of all other changes
        once these are durable.
        """
        if isinstance(notice, TaskChanged):
            return notice.state is TaskState.RUNNING
        if (isinstance(notice, Remember) and notice.fact is Fact.STEP) or not outlives_power(notice):
            return False
        if not isinstance(notice, Remember) or notice.fact is not Fact.EFFECTOR:
            return True
        return not any(notice.name in envelope.of_task(run) for run in self._runs.get(notice.name, ()))

    @property
    def version(self) -> int:
        """A number that changes whenever something other than a position changed."""
        return self.dispatcher.ledger.version + self.dispatcher.effectors.version + self._news.changes

    @property
    def acts(self) -> Sequence[OperatorAct]:
        """The last acts of operators, oldest first."""
        return self._operator.acts.last

    def advice(self, cell: str) -> tuple[Advice, ...]:
        """Advice that leads a cell out of its present state, in the order to do it; none where it works."""
        return self._advisor.advice(cell)

    def refusal(self, request: OperatorRequest) -> Sentence | None:
        """The reason why a request of an operator would be refused now; None where it would be done."""
        return self._operator.refusal(request)

    def jog_refusal(self, jog: Jog) -> Sentence | None:
        """The reason why this button would move nothing now; None where something would."""
        return self._people.jog_refusal(jog)

    def prospects(self, text: str) -> list[Prospect]:
        """The promise of each cell that a task text names; TextError or QueueFull where there is none."""
        return self._tasks.prospects(self.intake.orders(text))

    @property
    def at_rest(self) -> bool:
        """True where no command is open, and no task runs but those held for the next start."""
        runs = self.cells.values()
        ended = all(run.tree is None or (run.closed and run.state is CellState.HELD) for run in runs)
        return not self.dispatcher.ledger.entries and ended

    @property
    def may_restart(self) -> bool:
        """True where a restart is wanted, and would cut no task, command or teaching short."""
        return (
            self.restart_by != ""
            and self.at_rest
            and not any(run.manual.teaching for run in self.cells.values())
        )

    def at_work(self, holder: str) -> bool:
        """True where the work of a robot, or a cell, comes to an end by itself."""
        cell = self.cells.get(self.zones.holder(holder) or holder)  # of a shared robot the cell that holds it
        if cell is not None:
            return cell.state is CellState.EXECUTE
        executes = any(run.state is CellState.EXECUTE for run in self._runs.get(holder, ()))
        return executes or bool(self.dispatcher.ledger.of_robot(holder))

    def sleepers(self) -> list[str]:
        """Cells whose tree runs with nothing left to wake it; anything here is a defect."""
        awake = {entry.cell for entry in self.dispatcher.ledger.entries.values()}
        runs = [cell for cell in self.cells.values() if cell.tree and cell.state is CellState.EXECUTE]
        asleep = [cell.cell.name for cell in runs if not cell.context.time.wakes]
        return [name for name in asleep if name not in awake]

    def _run(self, cell: Cell, builders: Builders) -> CellRun:
        def build(order: Order, context: Context) -> Behaviour:
            make = builders.get(order.recipe) or context.cell.recipe(order.recipe).build
            return make(order, context)

        def ways_out(cell: str) -> Sequence[Advice]:
            return self._advisor.ways_out(cell)

        context = Context(cell, self.dispatcher, self.zones, self, self.at_work)
        stop = stop_of(cell, self.model, self.dispatcher.latches)
        return CellRun(cell, context, self._tasks.tell, build, ways_out, stop)

    def _use(self, model: PlantModel) -> None:
        self.model = self.dispatcher.model = model

    def _come_back(self, away_s: float) -> None:
        """Hold the cells that were at work when the plant fell silent.

        Robots have stopped themselves meanwhile, and people may have gone near them. So nothing that was
        under way moves before an operator says so, unless the plant file allows that. The absence counts from
        the plant's last step: the trees' time pauses there, so no wait of a step runs out meanwhile.
        """
        silent_since, self.now = self.now, self.now + away_s
        failure = Failure(reason=Reason.LINK_LOST, sentence=AWAY(seconds=away_s))
        self.dispatcher.outbox.append(Absence(seconds=away_s))
        self._first_homing.robots.clear()
        self._news.touched.update(self.cells)
        self._news.revised.update(self.cells)
        self._news.changes += 1
        for name, cell in self.cells.items():
            if cell.state is CellState.EXECUTE:
                cell.context.time.pause(at=silent_since)
            self._guard.run(name, partial(outlast, cell, failure))

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
                    self._news.revised.add(run.cell.name)
                    if run.state is not CellState.EXECUTE:  # such a cell waits for facts that reports show
                        self._news.touched.add(run.cell.name)
                if report.piece is not None and run.context.sensors.awaited:
                    run.context.sensors.awaited = False  # a leaf that waits on sets it again
                    self.dispatcher.ledger.changed.add(run.cell.name)
            if report.robot in self._first_homing.robots:
                self._news.revised.update(run.cell.name for run in runs)
                self._first_homing.look(report.robot)
        except Exception as error:  # noqa: BLE001 - whatever it is, it ends the work of this cell, not the plant
            self._guard.break_down(runs[0].cell.name, error)

    def _on_undelivered(self, event: Undelivered) -> None:
        cell = self.model.cell_of.get(event.robot)
        if cell is not None:
            fail = self.dispatcher.booking.undelivered
            self._guard.run(cell.name, partial(fail, event.id, event.robot, event.sentence, self.now))

    def _on_interference(self, event: Interference) -> None:
        if event.robot in self.dispatcher.beliefs:
            self.dispatcher.interfere(event.robot, event.sentence, event.at, obeyed=True)

    def _on_fault_by_hand(self, event: FaultByHand) -> None:
        self._news.changes += 1
        self.provoked.note(event.at, event.robot, event.sentence)
        cell = next((cell.name for cell in self.model.cells_of.get(event.robot, ())), None)
        entry = Journal(verb=None, scope=event.robot, cell=cell, sentence=event.sentence)
        self.dispatcher.outbox.append(entry)

    def _on_restart_request(self, event: RestartRequest) -> None:
        by = plain(event.by) or "-"
        self.restart_by = by if event.wanted else ""
        self._news.changes += 1
        for cell in self.cells.values():
            cell.queue.awaits_restart = event.wanted
        did = RESTART_WANTED if event.wanted else RESTART_UNWANTED
        self.dispatcher.outbox.append(Journal(verb=None, scope="", cell=None, sentence=did(by=by)))

    def _on_shutdown(self, event: Shutdown) -> None:
        self.intake.closed = True
        self._news.changes += 1  # it may hold a cell without any other message
        for name, cell in self.cells.items():
            self._guard.run(name, partial(cell.close, drops_waiting=event.drops_waiting))


def _doubt_stillness(dispatcher: Dispatcher, *, until: float) -> None:
    """Doubt that robots stand: their first reports may be older than their last moves of an earlier start."""
    for belief in dispatcher.beliefs.values():
        if belief.robot.goes:
            belief.stillness.doubt(until=until)


def _requests_last(events: Sequence[Event], now: float) -> list[Event]:
    """The events of a plant that was away: requests come last, as if people asked now.

    People mean the robots as they stand now, so the plant hears the robots' reports first.
    """
    requests = [replace(each, at=now) for each in events if isinstance(each, Request)]
    return [*(each for each in events if not isinstance(each, Request)), *requests]


def _note_clock(
    news: News, provoked: ProvokedFaults, outbox: list[Command | Notice], event: ClockSet
) -> None:
    news.changes += 1
    sentence = (CLOCK_AHEAD if event.seconds > 0 else CLOCK_BACK)(seconds=abs(event.seconds))
    provoked.note(event.at, "", sentence)
    outbox.append(Journal(verb=None, scope="", cell=None, sentence=sentence))
