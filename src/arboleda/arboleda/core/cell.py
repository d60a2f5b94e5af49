"""One cell at work: its queue, its current task, and the tree that carries the task out."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.dispatch.belief import Moment
from arboleda.dispatch.booking import BROKEN_OFF
from arboleda.dispatch.ledger import State
from arboleda.model.messages import Failure, Reason, RevisionName, TaskState, Verb
from arboleda.model.plant_model import Cell, Timing
from arboleda.model.recipe import Build
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.task import Task
from arboleda.trees import steps
from arboleda.trees.context import Context
from arboleda.trees.keeping import Keeping
from arboleda.trees.leaves import title_of
from arboleda.trees.part_places import trouble_in
from arboleda.trees.step_token import hash_of
from arboleda.trees.tree_run import TreeRun, path_of
from arboleda.trees.walk_back import NO_PART

from .absence import Absence
from .advice import Advice
from .cell_states import TABLE, Cause, CellState, after
from .manual_mode import ManualMode
from .readiness import Readiness
from .task_queue import TaskQueue


@dataclass(frozen=True, kw_only=True)
class NextVersion:
    """Another version of a cell, which it takes once it rests between two tasks; `taken` is told then."""

    version: RevisionName
    cell: Cell
    timing: Timing
    taken: Callable[[NextVersion], None]


class CellRun:
    """The moving part of a cell; `changed(task)` is told of every change of one of its tasks.

    `stop`: how far it came out of a stop of an earlier start, which is not over before clear and reset.
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
        self.queue = TaskQueue(cell)
        self.queue.paused = stop is not None
        self.readiness = Readiness(cell, context)
        self.ways_out = ways_out
        self.task: Task | None = None
        self.run = TreeRun(context)
        self.keeping = Keeping(context, self.run, build)
        self.awaits: Sentence | None = None  # for what a task of an earlier start waits before it can go on
        self.trouble: Failure | None = None  # why it is held
        self.stranded: Sentence | None = None  # why no step of a held task can go on from there
        self.place_trouble: Sentence | None = None  # for which the last task failed
        self.in_vain: set[tuple[Verb, str]] = set()  # what was done to get on, and failed, since it worked
        self.manual = ManualMode(context, self.queue)
        self.absence = Absence(context, self.run)
        self.dirty = False
        self.closed = False
        self.awaits_restart = False  # no further task begins before that
        self.following: NextVersion | None = None  # while it has not taken it
        self.version: RevisionName | None = None  # the one that it took while the plant ran
        self._changed = changed
        self._cancelling = False
        self._recovers_anew = False
        self._stopped_after: dict[str, Moment] = {}
        self._stop_by = 0.0

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
        """Why an idle cell would not start a task; None where it would, or is not idle."""
        if self.state is not CellState.IDLE:
            return None
        if self.manual.teaching is not None:
            return self.manual.teaching.sentence
        return self.readiness.objection() or (self.queue.why_paused if self.queue.paused else None)

    @property
    def waits_for_grip(self) -> bool:
        """True while only a part in a gripper holds the cell, so that it is idle as soon as that is out."""
        trouble = self.trouble if self.state is CellState.HELD and self.task is None else None
        return trouble is not None and trouble.reason is Reason.INTERRUPTED

    def advance(self, *, woken: bool) -> bool:
        """Do what can be done now: tick the tree until it rests, start the next task; whether it did."""
        self.dirty = self.context.time.woken() or woken or self.dirty
        if self.state is CellState.EXECUTE and not self.dirty:
            return False
        did = self.manual.teaching is not None and self.manual.go_on()
        did |= self._transit()
        if self.dirty and self.run.tree is not None and self.state is CellState.EXECUTE:
            self._look(self.run.tick())
            did = True
        if self.following is not None and self.is_between_tasks:
            self._revise(self.following)
            did = True
        if self.queue and self.state is CellState.IDLE and self._may_begin:
            self._start(self.queue.popleft())
            did = True
        self.dirty = False
        return did

    @property
    def _may_begin(self) -> bool:
        return not self.closed and not self.awaits_restart and self.not_ready is None

    @property
    def is_between_tasks(self) -> bool:
        """True where it can take another version: nobody teaches it, no task, tree or command is open."""
        if self.manual.teaching is not None or self.task is not None or self.run.tree is not None:
            return False
        return self.state in BETWEEN_TASKS and not self.context.commands.open()

    def _revise(self, following: NextVersion) -> None:
        self.following, self.version = None, following.version
        self.cell = following.cell
        self.context.revise(following.cell, following.timing)
        self.queue.revise(following.cell)
        self.readiness.revise(following.cell)
        self.keeping.revise()
        following.taken(following)

    def walk_back(self, task: Task, kept: str) -> None:
        """Hold a task that was at work when an earlier start ended, until a person says how it goes on."""
        self.task, self.queue.paused, self.state = task, True, CellState.HELD
        self.context.answers, self.context.commands.task = task.answers, hash_of(task.id)
        self.context.time.pause()
        self.stranded = self.keeping.revive(task.order, kept)
        trail = self.keeping.walk.trail if self.keeping.walk else None
        if trail is not None:
            self.trouble, self._cancelling = trail.failure, trail.cancels

    def look_back(self) -> None:
        """Judge a task of an earlier start by what its devices have said by now."""
        if self.keeping.walk is not None and self.state is CellState.HELD:
            self._judged()

    def trail(self) -> str | None:
        """The place of its task in the tree, to be kept; None where that is kept already."""
        if self.task is None or self.run.tree is None:
            return None
        holds = self.state in (CellState.HOLDING, CellState.HELD)
        why, cancels = self.task.failure, self._cancelling
        return self.keeping.news(failure=why, cancels=cancels, holds=holds, stranded=self.stranded)

    def stop(self) -> None:
        """The operator's stop (software): the task has failed; the robots are latched by the caller."""
        self.queue.paused = True
        self.manual.end(STOPPED(cell=self.cell.name))
        self.become(Cause.STOP)
        self.context.time.go_on()
        self.trouble = None
        self._stopped_after = self.context.robots.moments()
        self._stop_by = self.context.time.now + self.context.timing.stop_timeout_s
        failure = Failure(reason=Reason.STOPPED, sentence=STOPPED(cell=self.cell.name))
        self.interrupt(failure)
        self.context.commands.cancel_all()
        self.context.time.wake_at(self._stop_by)

    def hold(self) -> None:
        """Halt at once and keep everything for `resume`."""
        self.halt(Cause.HOLD)

    def halt(self, cause: Cause, trouble: Failure | None = None) -> None:
        """Hold the task for this cause, and halt what moves."""
        self.queue.paused = True
        self.trouble = trouble
        self.become(cause)
        self.context.time.pause()
        self.context.commands.cancel_motions()

    def resume(self) -> None:
        """Go on where `hold` interrupted, each interrupted step given anew; let an idle cell's queue run."""
        if self.state is CellState.HELD:
            self.go_on(Cause.RESUME)
        self.queue.resume()
        self.dirty = True

    def outlast(self, failure: Failure) -> None:
        """Hold what is at work, because the plant was away; a cell with nothing under way goes on.

        Where the plant file says so, a held one goes on too, as soon as its devices prove what they did.
        """
        if self.state is CellState.EXECUTE:
            paused = self.queue.paused
            self.halt(Cause.AWAY, failure)
            if self.cell.goes_on_after_absence and self.task is not None:
                self.absence.begin(failure, paused=paused)
        self.context.commands.cancel_motions()

    def lose(self, what: Sentence, failure: Failure | None = None) -> None:
        """Note that its task has lost what it needs to go on, so that it can only be abandoned."""
        if self.task is not None:
            self.trouble, self.stranded = failure or self.trouble, what

    def retry(self) -> None:
        """Give the step that failed anew; without a task, recover anew."""
        if self.task is not None:
            self.task.attempts += 1
            self.go_on(Cause.RETRY)
        else:
            self.become(Cause.RETRY)
            self.context.start_afresh()
            self._recover(anew=True)

    def abandon(self) -> None:
        """Give the task up and recover; without a task, leave the cell as it is."""
        if self.task is None:
            self._leave_as_it_is()
            return
        self.become(Cause.ABANDON)
        given_up = Failure(reason=Reason.CANCELLED, sentence=ABANDONED())
        if self.keeping.walk is not None and self.stranded is not None:
            given_up = Failure(reason=Reason.INTERRUPTED, sentence=self.stranded)
        self.task.fail(self.trouble or given_up)
        self._recover()

    def drop(self, task: Task, failure: Failure) -> None:
        """Take a task that waits out of the queue; it is cancelled."""
        self.queue.remove(task)
        task.fail(failure)
        task.become(TaskState.CANCELLED, self.context.time.plant_now)
        self._changed(task)

    def cancel(self, failure: Failure) -> None:
        """End the running task: halt, recover, then it is cancelled."""
        self._cancelling = True
        if self.task is not None:
            self.task.fail(failure)
        held = self.state is CellState.HELD
        if held:
            self.become(Cause.ABANDON)
        if held or not self.run.recovering:
            self._recover()

    def await_restart(self, *, wanted: bool) -> None:
        """Begin no further task, or go on with them where no restart is wanted any more."""
        self.awaits_restart, self.dirty = wanted, True

    def close(self, *, drops_waiting: bool) -> None:
        """The plant ends: what runs is halted and stays as it is for the next start, no other task starts.

        `drops_waiting`: there is no next start for the tasks of this one; they end.
        """
        self.closed = True
        self.manual.end(ASKED_TO_END())
        failure = Failure(reason=Reason.INTERRUPTED, sentence=ASKED_TO_END())
        if self.task is None or (drops_waiting and not self.task.is_kept):
            self.interrupt(failure)
        elif self.state is CellState.EXECUTE:
            self.halt(Cause.HOLD)
        for task in [each for each in self.queue if drops_waiting and not each.is_kept]:
            self.drop(task, failure)
        self.context.commands.cancel_all()

    def interrupt(self, failure: Failure) -> None:
        """End the task as failed without recovery; whatever moves for it is halted."""
        task, cancelled = self.task, self._cancelling
        self.run.drop()
        if task is not None:
            task.fail(failure)
            self._finish(task, TaskState.CANCELLED if cancelled else TaskState.FAILED)

    def break_down(self, failure: Failure) -> None:
        """Something of the cell raised: its task has failed, and it is held unless it is stopped."""
        self.context.time.go_on()
        self.manual.end(failure.sentence)
        self.interrupt(failure)
        if (self.state, Cause.STUCK) in TABLE:
            self._stuck(failure)

    def become(self, cause: Cause) -> None:
        """Change the state by its table; IllegalTransition where it has no row."""
        self.state = after(self.state, cause, self.cell.name)
        self.dirty = True

    def _transit(self) -> bool:
        """Leave a state that only waits for something to come true."""
        wait = WAITS.get(self.state)
        return wait is not None and wait(self)

    def _halted(self) -> bool:
        """Leave `holding` once no motion is open."""
        if any(entry.halts for entry in self.context.commands.open()):
            return False
        self.become(Cause.HALTED)
        self.trouble = self.trouble or self._fault()
        self._miss_part()
        return True

    def _cleared(self) -> bool:
        """Leave `clearing` once no robot says any more that it is stopped."""
        if self.context.robots.reports_a_latch():
            return False
        self.become(Cause.CLEARED)
        return True

    def _found_unsettled(self) -> bool:
        """Leave `idle` where a part may hang in the effector; while it is taught that is as it should be."""
        if self.manual.teaching is not None:
            return False
        unsettled = self.readiness.part_in_hand()
        if unsettled is None or self.context.commands.open():
            return False
        self._stuck(unsettled)
        return True

    def _settled(self) -> bool:
        """Leave `held` where only the effector was the trouble; else keep what goes wrong meanwhile."""
        if self.waits_for_grip and not self.context.parts.holding:
            self._leave_as_it_is()
            return True
        if self.keeping.walk is not None:
            return self._judged()
        if self.task is not None and self.trouble is None:
            self.trouble = self._fault()
        self._miss_part()
        return self.absence.hold is not None and self._absence_is_over()

    def _miss_part(self) -> None:
        """Note that an effector was opened meanwhile, by whomever."""
        if self.task is None or self.stranded:
            return
        gone = self.context.failures.opened_effector()
        if gone is not None:
            self.lose(NO_PART(arm=self.context.parts.opened_by or ""), gone)

    def _absence_is_over(self) -> bool:
        """Leave the hold that an absence of the plant has made, where nothing else is in its way."""
        hold = self.absence.end(None if self.stranded else self.trouble)
        if hold is None:
            return False
        self.go_on(Cause.RETRY)
        self.queue.paused = hold.paused
        return True

    def _judged(self) -> bool:
        """Look what devices say of the steps at which an earlier start ended; whether that is news.

        What keeps a task from going on stays so, whatever they say later.
        """
        if self.run.tree is None:
            return False
        before, found = (self.awaits, self.trouble, self.stranded), self.keeping.judge()
        self.awaits = found.waits
        self.trouble = self.trouble or found.failure
        self.stranded = self.stranded or found.stranded
        return before != (self.awaits, self.trouble, self.stranded)

    def _leave_as_it_is(self) -> None:
        """From held to idle without a move; a recovery that was held is given up."""
        self.run.drop()
        self.context.time.go_on()
        self.become(Cause.ENDED)
        self.trouble = None
        self.in_vain.clear()

    def _aborted(self) -> bool:
        """Leave `aborting` once every online robot is seen still, or the time for it is over."""
        moving = self.context.robots.moving_since(self._stopped_after)
        if moving and self.context.time.now < self._stop_by:
            return False
        if moving:
            sentence = STOP_UNCONFIRMED(robots=tuple(moving))
            self.trouble = Failure(reason=Reason.STOP_UNCONFIRMED, sentence=sentence)
        self.become(Cause.HALTED)
        return True

    def _fault(self) -> Failure | None:
        """The fault that came during a hold: an interrupted step that failed, a robot that cannot."""
        for act in self.run.interrupted():
            entry = act.entry
            if entry is not None and entry.state is State.FAILED and not entry.too_early:
                return entry.failure
        found = (self.context.robots.obstacle(robot.name, was=True) for robot in self.cell.reached)
        return next((failure for failure in found if failure), None)

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

    def _start(self, task: Task) -> None:
        self.task, self._cancelling, self._recovers_anew = task, False, False
        self.in_vain.clear()
        self.place_trouble = None
        self.context.answers, self.context.commands.task = task.answers, hash_of(task.id)
        self.become(Cause.TASK)
        task.become(TaskState.RUNNING, self.context.time.plant_now)
        self._changed(task)
        self.context.start_afresh()
        self.context.places.begin()
        self._look(self.run.begin(lambda: self.keeping.make(task.order)))

    def _recover(self, *, anew: bool = False) -> None:
        """Drop what runs, halting it, and run the recovery alone; `anew`: after one that failed."""
        self._recovers_anew = anew
        self.stranded = self.awaits = None
        self.keeping.end()
        self.run.drop()
        self.context.time.go_on()
        self.trouble = None
        self.context.parts.recover()
        self._look(self.run.begin(lambda: steps.recovery(self.context)))

    def set_parts(self, parts: Mapping[str, int]) -> None:
        """Take the word of a person on how many parts are at places, who has seen to these places then."""
        self.context.places.set(parts)
        if self.place_trouble is not None and self.place_trouble.values["place"] in parts:
            self.place_trouble = None

    def _look(self, status: Status) -> None:
        if status is not Status.RUNNING:
            self._ended(recovered=status is Status.SUCCESS)

    def _ended(self, *, recovered: bool) -> None:
        """The tree has come to its end: the task is over, and the cell ready or held."""
        task, found, leaf = self.task, self.context.failures.first, self.context.failures.leaf
        course = self.run.course
        self.run.drop()
        if not recovered:
            unknown = Failure(reason=Reason.INTERNAL, sentence=NO_CAUSE(cell=self.cell.name))
            self._fail_again(self.context.failures.last or unknown)
            self._stuck(self.context.failures.last or unknown)
        else:
            self.in_vain.clear()
            self.become(Cause.ENDED)
        if task is None:
            return
        self.place_trouble = None if found is None else trouble_in(found.sentence)
        if found is not None:
            task.fail(found, path_of(leaf) if leaf else None, title_of(leaf) if leaf else None)
        if self._cancelling:
            self._finish(task, TaskState.CANCELLED)
        elif task.failure:
            self._finish(task, TaskState.FAILED)
        else:
            task.course, task.unchecked = course, self.context.handling.unchecked
            self._finish(task, TaskState.DONE)

    def _fail_again(self, failure: Failure) -> None:
        """A recovery that somebody wanted once more has failed as well, by what the cell itself cannot do."""
        if self._recovers_anew and failure.reason not in BROKEN_OFF:
            self.in_vain.add((Verb.RETRY, self.cell.name))
            self.in_vain.update((Verb.RELEASE, robot) for robot in self.context.parts.unopened)

    def _stuck(self, failure: Failure) -> None:
        self.queue.paused = True
        self.trouble = failure
        self.become(Cause.STUCK)

    def _finish(self, task: Task, state: TaskState) -> None:
        self.task = self.stranded = self.awaits = None
        self.context.answers, self.context.commands.task = [], None
        self.keeping.end()
        task.become(state, self.context.time.plant_now)
        self._changed(task)


BETWEEN_TASKS = (CellState.IDLE, CellState.STOPPED, CellState.ABORTED)
STOPPED = Phrase("cell.stopped", "{cell} was stopped by the operator")
ABANDONED = Phrase("task.abandoned", "abandoned by the operator")
ASKED_TO_END = Phrase("task.plant_ends", "the plant was asked to end")
NO_CAUSE = Phrase("cell.no_cause", "{cell} failed without a cause")
STOP_UNCONFIRMED = Phrase("cell.stop_unconfirmed", "{robots} did not confirm the stop")
NOT_YET = Phrase("walk.not_yet", "{why}; until then nobody can tell what became of the step of {cell}")

WAITS: dict[CellState, Callable[[CellRun], bool]] = {
    CellState.HOLDING: CellRun._halted,
    CellState.ABORTING: CellRun._aborted,
    CellState.CLEARING: CellRun._cleared,
    CellState.IDLE: CellRun._found_unsettled,
    CellState.HELD: CellRun._settled,
}
