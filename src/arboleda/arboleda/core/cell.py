"""One cell at work: its queue, its current task, and the tree that carries the task out.

State, task and tree are three things. A held cell keeps its task and its tree as they are, and its time
stands, so that no wait of the tree runs out. A recovery is a tree of its own, and may run without a task.
`advance` is what a cell does by itself, in the rounds of a step. All other acts are asked for by verbs and
events, and do not ask whether they are allowed: a verb asks before, and the table of states refuses the rest.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.dispatch.booking import BROKEN_OFF
from arboleda.dispatch.stillness import ReportMoment
from arboleda.model.advice import Advice
from arboleda.model.cell_states import Cause, CellState, after
from arboleda.model.messages import Failure, Reason, RevisionName, TaskState, Verb
from arboleda.model.plant_model import Cell, Timing
from arboleda.model.recipe import Build
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.step_token import hash_of
from arboleda.model.task import Task
from arboleda.resume.keeping import Keeping
from arboleda.trees import steps
from arboleda.trees.context import Context
from arboleda.trees.leaves import title_of
from arboleda.trees.part_places import trouble_in
from arboleda.trees.tree_run import TreeRun, path_of

from .absence import HoldAfterAbsence
from .acts import FailedVerbs
from .manual_mode import ManualMode
from .readiness import Readiness
from .task_queue import TaskQueue


@dataclass(frozen=True, kw_only=True)
class NextVersion:
    """Another version of a cell, which takes it between two tasks; `taken` is called then."""

    version: RevisionName
    cell: Cell
    timing: Timing
    taken: Callable[[NextVersion], None]


class CellRun:
    """A cell at work: its state, queue, task and tree. `changed(task)` hears of every change of its tasks.

    `stop` is the state of a cell that was stopped in an earlier start: a stop lasts until clear and reset.
    """

    def __init__(
        self,
        cell: Cell,
        context: Context,
        changed: Callable[[Task], None],
        build: Build,
        ways_out: Callable[[str], Sequence[Advice]] = lambda cell: (),
        stop: CellState | None = None,
    ) -> None:
        self.cell = cell
        self.context = context
        self.state = stop or CellState.IDLE
        self.queue = TaskQueue(cell, context.time, changed)
        self.queue.paused = stop is not None
        self.readiness = Readiness(cell, context)
        self.ways_out = ways_out
        self.task: Task | None = None
        self.run = TreeRun(context)
        self.keeping = Keeping(context, self.run, build)
        self.awaits: Sentence | None = None  # what a task of an earlier start waits for
        self.trouble: Failure | None = None  # why it is held
        self.stranded: Sentence | None = None  # why a held task can only be abandoned
        self.in_vain = FailedVerbs()
        self.manual = ManualMode(context, self.queue)
        self.absence = HoldAfterAbsence(context, self.run)
        self.dirty = False  # True where something happened to it since `advance`
        self.closed = False
        self.following: NextVersion | None = None  # put to work, and not taken yet
        self.version: RevisionName | None = None  # taken while the plant ran
        self.cancelling = False  # True while its task is to end as cancelled
        self.stopped_after: dict[str, ReportMoment] = {}  # of its robots, at its last stop
        self.stop_by = 0.0  # when they have to stand, or to have left their stop, s of the cell's time
        self._changed = changed
        self._recovers_anew = False

    @property
    def tree(self) -> Behaviour | None:
        """The tree that runs; None while there is none."""
        return self.run.tree

    @property
    def due(self) -> float | None:
        """The time at which the cell is to be looked at although nothing happens, s of the plant's time."""
        walk = self.keeping.walk
        due = self.context.time.next_deadline if walk is None else walk.due
        if self.manual.teaching is None:
            return due
        return self.manual.teaching.due if due is None else min(due, self.manual.teaching.due)

    @property
    def not_ready(self) -> Sentence | None:
        """The reason why an idle cell would not start a task; None where it would, or is not idle."""
        if self.state is not CellState.IDLE:
            return None
        if self.manual.teaching is not None:
            return self.manual.teaching.sentence
        return self.readiness.objection() or (self.queue.why_paused if self.queue.paused else None)

    @property
    def is_between_tasks(self) -> bool:
        """True where it can take another version: nobody teaches it, no task, tree or command is open."""
        if self.manual.teaching is not None or self.task is not None or self.run.tree is not None:
            return False
        return self.state in BETWEEN_TASKS and not self.context.commands.open()

    def stop(self) -> None:
        """Stop (software), for an operator: the task has failed, and its robots are latched by the caller.

        It asks no robot first and waits for none: the state stays `aborting` until reports show all standing.
        """
        self.queue.paused = True
        self.manual.end(STOPPED(cell=self.cell.name))
        self.become(Cause.STOP)
        self.context.time.go_on()
        self.trouble = None
        self.stopped_after = self.context.robots.moments()
        self.stop_by = self.context.time.now + self.context.timing.stop_timeout_s
        failure = Failure(reason=Reason.STOPPED, sentence=STOPPED(cell=self.cell.name))
        self.interrupt(failure)
        self.context.commands.cancel_all()
        self.context.time.wake_at(self.stop_by)

    def halt(self, cause: Cause, trouble: Failure | None = None) -> None:
        """Hold the task for this cause, and halt what moves."""
        self.queue.paused = True
        self.trouble = trouble
        self.become(cause)
        self.context.time.pause()
        self.context.commands.cancel_motions()

    def lose(self, why: Sentence, failure: Failure | None = None) -> None:
        """Note why its task, if one runs, can only be abandoned."""
        if self.task is not None:
            self.trouble, self.stranded = failure or self.trouble, why

    def note(self, failure: Failure | None) -> None:
        """Note why it is held, unless that is known: the first trouble is what people have to mend."""
        self.trouble = self.trouble or failure

    def judge(self) -> bool:
        """Judge the steps at which an earlier start left its task, by its devices; True where that is news.

        A reason that keeps the task from going on stays, whatever devices report later.
        """
        if self.run.tree is None:
            return False
        before, finding = (self.awaits, self.trouble, self.stranded), self.keeping.judge()
        self.awaits = finding.waits
        self.trouble = self.trouble or finding.failure
        self.stranded = self.stranded or finding.stranded
        return before != (self.awaits, self.trouble, self.stranded)

    def advance(self, leave: Mapping[CellState, Callable[[CellRun], bool]], *, woken: bool) -> bool:
        """Leave a state that waits, tick the tree, start the next task; True where anything was done.

        `leave` has a function for each state that waits. A cell takes another version before its next task,
        so no task begins by one version and ends by another.
        """
        self.dirty = self.context.time.woken() or woken or self.dirty
        if self.state is CellState.EXECUTE and not self.dirty:
            return False
        did = self.manual.teaching is not None and self.manual.go_on()
        waits = leave.get(self.state)
        did |= waits is not None and waits(self)
        if self.dirty and self.run.tree is not None and self.state is CellState.EXECUTE:
            self.look(self.run.tick())
            did = True
        if self.following is not None and self.is_between_tasks:
            self._revise(self.following)
            did = True
        may_begin = self.queue and not (self.closed or self.queue.awaits_restart)
        if may_begin and self.state is CellState.IDLE and self.not_ready is None:
            self.start(self.queue.popleft())
            did = True
        self.dirty = False
        return did

    def follow(self, version: NextVersion) -> None:
        """Take another version once it is between two tasks."""
        self.following = version

    def _revise(self, following: NextVersion) -> None:
        self.following, self.version = None, following.version
        self.cell = following.cell
        self.context.revise(following.cell, following.timing)
        self.queue.revise(following.cell)
        self.readiness.revise(following.cell)
        self.keeping.revise()
        following.taken(following)

    def close(self, *, drops_waiting: bool) -> None:
        """The plant ends: a running task is halted and kept for the next start, and no other task starts.

        `drops_waiting`: no start comes after this one, so its tasks end.
        """
        self.closed = True
        self.manual.end(ASKED_TO_END())
        failure = Failure(reason=Reason.INTERRUPTED, sentence=ASKED_TO_END())
        if self.task is None or (drops_waiting and not self.task.is_kept):
            self.interrupt(failure)
        elif self.state is CellState.EXECUTE:
            self.halt(Cause.HOLD)
        for task in [each for each in self.queue if drops_waiting and not each.is_kept]:
            self.queue.drop(task, failure)
        self.context.commands.cancel_all()

    def interrupt(self, failure: Failure) -> None:
        """End the task as failed without recovery; whatever moves for it is halted."""
        task, cancelled = self.task, self.cancelling
        self.run.drop()
        if task is not None:
            task.fail(failure)
            self._finish(task, TaskState.CANCELLED if cancelled else TaskState.FAILED)

    def become(self, cause: Cause) -> None:
        """Change the state by its table; IllegalTransition where it has no row."""
        self.state = after(self.state, cause, self.cell.name)
        self.dirty = True

    def leave_as_it_is(self) -> None:
        """Go from held to idle without a move, and give up a recovery that was held."""
        self.run.drop()
        self.context.time.go_on()
        self.become(Cause.ENDED)
        self.trouble = None
        self.in_vain.clear()

    def go_on(self, cause: Cause) -> None:
        """Leave a hold, each interrupted step given anew."""
        self.become(cause)
        self.trouble = None
        self.context.time.go_on()
        if self.keeping.walk is not None:
            self.keeping.go_on()
            return
        for act in self.run.interrupted():
            act.send()

    def start(self, task: Task) -> None:
        """Begin a task."""
        self.task, self.cancelling, self._recovers_anew = task, False, False
        self.in_vain.clear()
        self.context.answers, self.context.commands.task = task.answers, hash_of(task.id)
        self.become(Cause.TASK)
        task.become(TaskState.RUNNING, self.context.time.plant_now)
        self._changed(task)
        self.context.start_afresh()
        self.context.places.begin()
        self.look(self.run.begin(lambda: self.keeping.make(task.order)))

    def take_up(self, task: Task, trail_text: str) -> None:
        """Hold a task that was at work when an earlier start ended, until a person says how it goes on."""
        self.task, self.queue.paused = task, True
        self.become(Cause.AWAY)
        self.context.answers, self.context.commands.task = task.answers, hash_of(task.id)
        self.context.time.pause()
        self.stranded = self.keeping.revive(task.order, trail_text)
        trail = self.keeping.walk.trail if self.keeping.walk else None
        if trail is not None:
            self.trouble, self.cancelling = trail.failure, trail.cancels

    def cancel(self, failure: Failure) -> None:
        """End the running task: halt, recover, then it is cancelled."""
        self.cancelling = True
        if self.task is not None:
            self.task.fail(failure)
        held = self.state is CellState.HELD
        if held:
            self.become(Cause.ABANDON)
        if held or not self.run.recovering:
            self.recover()

    def recover(self, *, anew: bool = False) -> None:
        """Drop and halt the task's tree, and run the recovery alone; `anew`: after a recovery that failed."""
        self._recovers_anew = anew
        self.stranded = self.awaits = None
        self.keeping.end()
        self.run.drop()
        self.context.time.go_on()
        self.trouble = None
        self.context.parts.recover()
        self.look(self.run.begin(lambda: steps.recovery(self.context)))

    def look(self, status: Status) -> None:
        """Take the status that a tick of the tree has returned: at its end the cell is idle, or held."""
        if status is Status.RUNNING:
            return
        recovered = status is Status.SUCCESS
        task, failure, leaf = self.task, self.context.failures.first, self.context.failures.leaf
        course = self.run.course
        self.run.drop()
        if not recovered:
            unknown = Failure(reason=Reason.INTERNAL, sentence=NO_CAUSE(cell=self.cell.name))
            last = self.context.failures.last or unknown
            # where something outside of the cell broke a retried recovery off, a further retry may help
            if self._recovers_anew and last.reason not in BROKEN_OFF:
                self.in_vain.add((Verb.RETRY, self.cell.name))
                self.in_vain.update((Verb.RELEASE, robot) for robot in self.context.parts.unopened)
            self.stuck(last)
        else:
            self.in_vain.clear()
            self.become(Cause.ENDED)
        if task is None:
            return
        self.context.places.asked.note(None if failure is None else trouble_in(failure.sentence))
        if failure is not None:
            task.fail(failure, path_of(leaf) if leaf else None, title_of(leaf) if leaf else None)
        if self.cancelling:
            self._finish(task, TaskState.CANCELLED)
        elif task.failure:
            self._finish(task, TaskState.FAILED)
        else:
            task.course, task.unchecked = course, self.context.handling.unchecked
            self._finish(task, TaskState.DONE)

    def stuck(self, failure: Failure) -> None:
        """Hold a cell that cannot go on by itself."""
        self.queue.paused = True
        self.trouble = failure
        self.become(Cause.STUCK)

    def _finish(self, task: Task, state: TaskState) -> None:
        self.task = self.stranded = self.awaits = None
        self.context.answers, self.context.commands.task = [], None
        self.keeping.end()
        if state is not TaskState.DONE:
            self.context.places.asked.fail()
        task.become(state, self.context.time.plant_now)
        self._changed(task)
        self.run.take_apart()


BETWEEN_TASKS = (CellState.IDLE, CellState.STOPPED, CellState.ABORTED)
STOPPED = Phrase("cell.stopped", "{cell} was stopped by the operator")
ASKED_TO_END = Phrase("task.plant_ends", "the plant was asked to end")
NO_CAUSE = Phrase("cell.no_cause", "{cell} failed without a cause")
