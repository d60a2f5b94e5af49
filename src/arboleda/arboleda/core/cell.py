"""One cell at work: its queue, its current task, and the tree that carries the task out."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.dispatch.belief import Moment
from arboleda.dispatch.dispatcher import BROKEN_OFF
from arboleda.dispatch.ledger import State
from arboleda.model.commands import Motion, Question
from arboleda.model.errors import QueueFull
from arboleda.model.grips import Grip
from arboleda.model.messages import Failure, Reason, TaskState, Verb
from arboleda.model.plant_model import Cell
from arboleda.model.recipe import Build
from arboleda.model.sentence import BOTH, NOTHING, Phrase, Sentence
from arboleda.model.task import Task
from arboleda.trees import steps
from arboleda.trees.context import Context
from arboleda.trees.keeping import Keeping
from arboleda.trees.tree_run import TreeRun, path_of, step_of
from arboleda.trees.walk_back import NO_PART

from . import advice
from .advice import Advice
from .cell_states import TABLE, Cause, CellState, after


@dataclass(frozen=True, kw_only=True)
class GoesOn:
    """A hold that an absence made and that ends by itself, `by` s of the plant's time at the latest.

    It ends only while `trouble` is the one that made it, and once each device is seen at rest after `since`;
    `paused` is how the queue was before.
    """

    trouble: Failure
    since: dict[str, Moment]
    by: float
    paused: bool


class CellRun:
    """The moving part of a cell; `changed(task)` is told of every change of one of its tasks."""

    def __init__(
        self,
        cell: Cell,
        context: Context,
        changed: Callable[[Task], None],
        build: Build,
        ways_out: Callable[[str], Sequence[Advice]] = lambda cell: (),
    ) -> None:
        self.cell = cell
        self.context = context
        self.state = CellState.IDLE
        self.queue: deque[Task] = deque()
        self.queue_paused = False
        self.task: Task | None = None
        self.run = TreeRun(context)
        self.keeping = Keeping(context, self.run, build)
        self.awaits: Sentence | None = None  # for what a task of an earlier start waits before it can go on
        self.trouble: Failure | None = None  # why it is held
        self.stranded: Sentence | None = None  # why no step of a held task can go on from there
        self.in_vain: set[tuple[Verb, str]] = set()  # what was done to get on, and failed, since it worked
        self.left_over = False  # whether tasks of an earlier start wait, since nobody said `resume`
        self.dirty = False
        self.closed = False
        self._goes_on: GoesOn | None = None  # how it gets out of a hold by itself, after an absence
        self._changed = changed
        self._ways_out = ways_out
        self._cancelling = False
        self._recovers_anew = False
        self._stopped_after: dict[str, Moment] = {}
        self._stop_by = 0.0

    @property
    def tree(self) -> Behaviour | None:
        """The tree that runs; None while there is none."""
        return self.run.tree

    def enqueue(self, task: Task) -> None:
        """Take a task in; QueueFull at the limit."""
        if self.is_full:
            full = FULL_OF_ONE if len(self.queue) == 1 else FULL
            raise QueueFull(full(cell=self.cell.name, number=len(self.queue)))
        self.queue.append(task)

    def waiting_for(self) -> Sentence | None:
        """Why the next task does not start, for the operator; None where nothing is in its way."""
        name = self.cell.name
        if self.closed:
            return ENDING()
        if self.state is CellState.EXECUTE:
            return BUSY(cell=name)
        if self.state is CellState.IDLE:
            return self.not_ready
        if self.trouble is None or self.state is CellState.HELD:
            return self.held_by or STANDS(cell=name, state=self.state.said, next=self._next())
        why = self.trouble.sentence
        return STANDS_BECAUSE(cell=name, state=self.state.said, why=why, next=self._next())

    @property
    def hindrance(self) -> Sentence | None:
        """Why a task that came now would not start by itself after those before it; None where it would."""
        if self.state is not CellState.EXECUTE:
            return self.waiting_for()
        for robot in self.cell.reached:
            if (obstacle := self.context.obstacle_at_work(robot.name)) is not None:
                return obstacle.sentence
        return self.why_paused if self.queue_paused else None

    @property
    def is_full(self) -> bool:
        """Whether no further task has room in its queue."""
        return len(self.queue) >= self.cell.queue_limit

    @property
    def due(self) -> float | None:
        """When it is to be looked at although nothing happens, s of the plant's time."""
        walk = self.keeping.walk
        return self.context.next_deadline if walk is None else walk.due

    @property
    def not_ready(self) -> Sentence | None:
        """Why an idle cell would not start a task; None where it would, or is not idle."""
        if self.state is not CellState.IDLE:
            return None
        return self._unready() or (self.why_paused if self.queue_paused else None)

    @property
    def held_by(self) -> Sentence | None:
        """What holds the cell and what can be done about it; None where it is not held."""
        if self.state is not CellState.HELD:
            return None
        name, why, ways = self.cell.name, self.why_held, self._next()
        if self.stranded:
            return HELD_STRANDED(cell=name, why=why, stranded=self.stranded, next=ways)
        return HELD(cell=name, why=why, next=ways)

    @property
    def is_held(self) -> bool:
        return self.state is CellState.HELD

    @property
    def waits_for_grip(self) -> bool:
        """Whether only a part in a gripper holds the cell, so that it is idle as soon as that is out."""
        trouble = self.trouble if self.is_held and self.task is None else None
        return trouble is not None and trouble.reason is Reason.INTERRUPTED

    @property
    def goes_on(self) -> bool:
        """Whether it gets out of its hold by itself, once its devices have proved what they did."""
        return self._goes_on is not None

    @property
    def why_held(self) -> Sentence:
        """The cause of a hold."""
        why = self.trouble.sentence if self.trouble else None
        if (at_work := self._at_work) is None:
            return why or BY_OPERATOR()
        return BOTH(first=at_work, second=why) if why else at_work

    @property
    def _at_work(self) -> Sentence | None:
        """That its task was at work when an earlier start ended, until somebody says how it goes on."""
        if self.keeping.walk is None or self.task is None:
            return None
        step = step_of(self.tree)
        return WAS_AT_WORK(task=self.task.id) if step is None else STANDS_AT(task=self.task.id, step=step)

    @property
    def found(self) -> Sentence | None:
        """What this start has found of a task that was at work, and what to do."""
        if (at_work := self._at_work) is None:
            return None
        what = FOUND if self.stranded is None else FOUND_STRANDED
        return what(cell=self.cell.name, found=at_work, why=self.stranded or NOTHING)

    @property
    def why_stopped(self) -> Sentence:
        """The cause of a stop, or that it was not confirmed."""
        return self.trouble.sentence if self.trouble else STOPPED(cell=self.cell.name)

    @property
    def why_paused(self) -> Sentence:
        if self.left_over and self.queue:
            one_or_more = LEFT_OVER_ONE if len(self.queue) == 1 else LEFT_OVER
            return one_or_more(cell=self.cell.name, number=len(self.queue))
        return QUEUE_PAUSED(cell=self.cell.name)

    def _next(self) -> Sentence:
        """What leads out of the present state."""
        if self.state in NEXT:
            return NEXT[self.state]()
        return advice.sentence(self._ways_out(self.cell.name)) or self._busy() or WAIT()

    def advance(self, *, woken: bool) -> bool:
        """Do what can be done now: tick the tree until it rests, start the next task; whether it did."""
        self.dirty = self.context.woken() or woken or self.dirty
        if self.state is CellState.EXECUTE and not self.dirty:
            return False
        did = self._transit()
        if self.dirty and self.run.tree is not None and self.state is CellState.EXECUTE:
            self._look(self.run.tick())
            did = True
        if self.state is CellState.IDLE and self.queue and self.waiting_for() is None:
            self._start(self.queue.popleft())
            did = True
        self.dirty = False
        return did

    def take_back(self, waiting: Sequence[Task], *, cut_off: bool) -> None:
        """The tasks that waited here when an earlier start ended, be they more than the limit.

        They start once somebody says so, or where the cell goes on by itself and none was cut off at work.
        """
        self.queue += waiting
        if waiting and (cut_off or not self.cell.goes_on):
            self.queue_paused = self.left_over = True

    def walk_back(self, task: Task, kept: str) -> None:
        """Hold a task that was at work when an earlier start ended, until a person says how it goes on."""
        self.task, self.queue_paused, self.state = task, True, CellState.HELD
        self.context.answers = task.answers
        self.context.pause()
        self.stranded = self.keeping.revive(task.order, kept)
        trail = self.keeping.walk.trail if self.keeping.walk else None
        if trail is not None:
            self.trouble, self._cancelling = trail.failure, trail.cancels

    def look_back(self) -> None:
        """Judge a task of an earlier start by what its devices have said by now."""
        if self.keeping.walk is not None and self.state is CellState.HELD:
            self._judged()

    def trail(self) -> str | None:
        """Where its task stands, to be kept for the next start; None where that is kept already."""
        if self.task is None or self.run.tree is None:
            return None
        holds = self.state in (CellState.HOLDING, CellState.HELD)
        why, cancels = self.task.failure, self._cancelling
        return self.keeping.news(failure=why, cancels=cancels, holds=holds, stranded=self.stranded)

    def start_in(self, state: CellState) -> None:
        """The plant starts with a stop of an earlier start: it is not over before clear and reset."""
        self.queue_paused = True
        self.state = state

    def stop(self) -> None:
        """The operator's stop (software): the task has failed; the robots are latched by the caller."""
        self.queue_paused = True
        self.become(Cause.STOP)
        self.context.go_on()
        self.trouble = None
        self._stopped_after = self.context.moments()
        self._stop_by = self.context.now + self.context.timing.stop_timeout_s
        failure = Failure(reason=Reason.STOPPED, sentence=STOPPED(cell=self.cell.name))
        self.interrupt(failure)
        self.context.cancel_all()
        self.context.wake_at(self._stop_by)

    def hold(self) -> None:
        """Halt at once and keep everything for `resume`."""
        self._hold(Cause.HOLD)

    def hold_after_absence(self, failure: Failure) -> None:
        """The plant was away: what was at work is held; a cell with nothing under way goes on.

        Where the plant file says so, a held one goes on too, as soon as its devices prove what they did. That
        has to be within the time in which they confirm a stop: later nobody expects a move any more.
        """
        if self.state is CellState.EXECUTE:
            paused = self.queue_paused
            self._hold(Cause.AWAY, failure)
            if self.cell.goes_on_after_absence and self.task is not None:
                by = self.context.plant_now + self.context.timing.stop_timeout_s
                moments = self.context.moments()
                self._goes_on = GoesOn(trouble=failure, since=moments, by=by, paused=paused)
        self.context.cancel_motions()

    def _hold(self, cause: Cause, trouble: Failure | None = None) -> None:
        self.queue_paused = True
        self.trouble = trouble
        self.become(cause)
        self.context.pause()
        self.context.cancel_motions()

    def resume(self) -> None:
        """Go on where `hold` interrupted, each interrupted step given anew; let an idle cell's queue run."""
        if self.state is CellState.HELD:
            self._again(Cause.RESUME)
        self.queue_paused = False
        self.left_over = False
        self.dirty = True

    def retry(self) -> None:
        """Give the step that failed anew; without a task, recover anew."""
        if self.task is not None:
            self.task.attempts += 1
            self._again(Cause.RETRY)
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
        task.become(TaskState.CANCELLED, self.context.plant_now)
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

    def close(self, *, drops_waiting: bool) -> None:
        """The plant ends: what runs is halted and stays as it is for the next start, no other task starts.

        `drops_waiting`: there is no next start for the tasks of this one; they end.
        """
        self.closed = True
        asked = Failure(reason=Reason.INTERRUPTED, sentence=ASKED_TO_END())
        if self.task is None or (drops_waiting and not self.task.is_kept):
            self.interrupt(asked)
        elif self.state is CellState.EXECUTE:
            self._hold(Cause.HOLD)
        for task in [each for each in self.queue if drops_waiting and not each.is_kept]:
            self.drop(task, asked)
        self.context.cancel_all()

    def interrupt(self, failure: Failure) -> None:
        """End the task as failed without recovery; whatever moves for it is halted."""
        task, cancelled = self.task, self._cancelling
        self.run.drop()
        if task is not None:
            task.fail(failure)
            self._finish(task, TaskState.CANCELLED if cancelled else TaskState.FAILED)

    def break_down(self, failure: Failure) -> None:
        """Something of the cell raised: its task has failed, and it is held unless it is stopped."""
        self.context.go_on()
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
        if any(entry.halts for entry in self.context.open_commands()):
            return False
        self.become(Cause.HALTED)
        self.trouble = self.trouble or self._fault()
        self._miss_part()
        return True

    def _cleared(self) -> bool:
        """Leave `clearing` once no robot says any more that it is stopped."""
        if self.context.reports_a_latch():
            return False
        self.become(Cause.CLEARED)
        return True

    def _found_unsettled(self) -> bool:
        """Leave `idle` where a part may hang in the effector."""
        unsettled = self._grip_unsettled()
        if unsettled is None or self.context.open_commands():
            return False
        self._stuck(unsettled)
        return True

    def _settled(self) -> bool:
        """Leave `held` where only the effector was the trouble; else keep what goes wrong meanwhile."""
        if self.waits_for_grip and not self.context.holding:
            self._leave_as_it_is()
            return True
        if self.keeping.walk is not None:
            return self._judged()
        if self.task is not None and self.trouble is None:
            self.trouble = self._fault()
        self._miss_part()
        return self._gone_on()

    def _gone_on(self) -> bool:
        """Leave `held` after an absence, where nothing else is in the way and what was at work is proved."""
        goes_on, self._goes_on = self._goes_on, None
        if goes_on is None or self.trouble is not goes_on.trouble or self.stranded:
            return False
        if self.context.plant_now > goes_on.by:
            return False
        if self.context.open_commands() or not self._proved(goes_on.since):
            self._goes_on = goes_on  # until its devices have said what they did
            return False
        self._again(Cause.RETRY)
        self.queue_paused = goes_on.paused
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

    def _miss_part(self) -> None:
        """A held task whose effector was opened meanwhile has nothing to go on with."""
        gone = self.context.part_gone()
        if gone is not None and self.task is not None and not self.stranded:
            self.trouble = gone
            self.stranded = NO_PART(arm=self.context.lost_by or "")
            self.dirty = True

    def _leave_as_it_is(self) -> None:
        """From held to idle without a move; a recovery that was held is given up."""
        self.run.drop()
        self.context.go_on()
        self.become(Cause.ENDED)
        self.trouble = None
        self.in_vain.clear()

    def _aborted(self) -> bool:
        """Leave `aborting` once every online robot is seen still, or the time for it is over."""
        moving = self.context.moving_since(self._stopped_after)
        if moving and self.context.now < self._stop_by:
            return False
        if moving:
            sentence = STOP_UNCONFIRMED(robots=tuple(moving))
            self.trouble = Failure(reason=Reason.STOP_UNCONFIRMED, sentence=sentence)
        self.become(Cause.HALTED)
        return True

    def _unready(self) -> Sentence | None:
        if busy := self._busy():
            return busy
        found = [self.context.obstacle(robot.name) for robot in self.cell.reached]
        astray = self.context.astray()
        found += [astray[1] if astray else None, self._grip_unsettled()]
        return next((failure.sentence for failure in found if failure), None)

    def _busy(self) -> Sentence | None:
        """What a robot of the cell is still doing, or who is still to answer."""
        first = next(iter(self.context.open_commands()), None)
        if first is None:
            return None
        if isinstance(first.command, Question):
            return STILL_ASKED(person=first.command.robot)
        return STILL_DOING(robot=first.command.robot, doing=first.doing)

    def _grip_unsettled(self) -> Failure | None:
        robot = next(iter(self.context.holding), None)
        if robot is None:
            return None
        return Failure(reason=Reason.INTERRUPTED, sentence=self._may_hold(robot))

    def _may_hold(self, robot: str) -> Sentence:
        """That a robot may hold a part, and by what."""
        device = next(each for each in self.cell.robots if each.name == robot)
        grip, fact = self.context.grip(robot), device.held_fact
        if device.has_effector or fact is None:
            return MAY_HOLD(arm=robot, grip=GRIPS[grip]())
        return MAY_HOLD_BY_FACT(device=robot, fact=fact, grip=HELD_AS[grip]())

    def _fault(self) -> Failure | None:
        """What went wrong while the cell was held: an interrupted step that failed, a robot that cannot."""
        for act in self.run.interrupted():
            entry = act.entry
            if entry is not None and entry.state is State.FAILED and not entry.too_early:
                return entry.failure
        found = (self.context.obstacle(robot.name, was=True) for robot in self.cell.reached)
        return next((failure for failure in found if failure), None)

    def _proved(self, since: dict[str, Moment]) -> bool:
        """Whether its devices are at rest and can work, and what was at work may be given anew.

        A motion whose robot was not heard meanwhile may: it begins wherever the robot stands now.
        """
        for entry in [act.entry for act in self.run.interrupted() if act.entry is not None]:
            lost = entry.failure is not None and entry.failure.reason is Reason.LINK_LOST
            anew = entry.too_early or (lost and isinstance(entry.command, Motion))
            if entry.state is State.FAILED and not anew:
                return False
        able = all(self.context.obstacle(robot.name) is None for robot in self.cell.reached)
        return able and not self.context.moving_since(since)

    def _again(self, cause: Cause) -> None:
        self.become(cause)
        self.trouble = None
        self.context.go_on()
        if self.keeping.walk is not None:
            self.keeping.go_on()
            return
        for act in self.run.interrupted():
            act.send()

    def _start(self, task: Task) -> None:
        self.task, self._cancelling, self._recovers_anew = task, False, False
        self.in_vain.clear()
        self.context.answers = task.answers
        self.become(Cause.TASK)
        task.become(TaskState.RUNNING, self.context.plant_now)
        self._changed(task)
        self.context.start_afresh()
        self._look(self.run.begin(lambda: self.keeping.make(task.order)))

    def uproot(self, robot: str) -> None:
        """A robot that goes from pose to pose is homed: a task that is held can only be abandoned."""
        if self.task is not None and robot in self.cell.workspaces:
            self.stranded = HOMED_MEANWHILE(arm=robot)

    def let_go(self, robot: str) -> None:
        """The operator has an effector opened: a task that is held has lost the part in it."""
        if self.task is not None and robot in self.context.holding:
            self.trouble = self.trouble or Failure(reason=Reason.PART_LOST, sentence=LET_GO(arm=robot))
            self.stranded = NO_PART(arm=robot)

    def _recover(self, *, anew: bool = False) -> None:
        """Drop what runs, halting it, and run the recovery alone; `anew`: after one that failed."""
        self._recovers_anew = anew
        self.stranded = self.awaits = None
        self.keeping.end()
        self.run.drop()
        self.context.go_on()
        self.trouble = None
        self.context.carrier, self.context.delivers = None, False
        self._look(self.run.begin(lambda: steps.recovery(self.context)))

    def _look(self, status: Status) -> None:
        if status is not Status.RUNNING:
            self._ended(recovered=status is Status.SUCCESS)

    def _ended(self, *, recovered: bool) -> None:
        """The tree has come to its end: the task is over, and the cell ready or held."""
        task, found, leaf = self.task, self.context.failure, self.context.failed_leaf
        course = self.run.course
        self.run.drop()
        if not recovered:
            unknown = Failure(reason=Reason.INTERNAL, sentence=NO_CAUSE(cell=self.cell.name))
            self._fail_again(self.context.last_failure or unknown)
            self._stuck(self.context.last_failure or unknown)
        else:
            self.in_vain.clear()
            self.become(Cause.ENDED)
        if task is None:
            return
        if found is not None:
            task.fail(found, path_of(leaf) if leaf else None)
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
            self.in_vain.update((Verb.RELEASE, robot) for robot in self.context.unopened)

    def _stuck(self, failure: Failure) -> None:
        self.queue_paused = True
        self.trouble = failure
        self.become(Cause.STUCK)

    def _finish(self, task: Task, state: TaskState) -> None:
        self.task = self.stranded = self.awaits = None
        self.context.answers = []
        self.keeping.end()
        task.become(state, self.context.plant_now)
        self._changed(task)


FULL = Phrase("cell.full", "{cell} has {number:,} tasks waiting, its limit; send it again later")
FULL_OF_ONE = Phrase("cell.full_of_one", "{cell} has {number} task waiting, its limit; send it again later")
ENDING = Phrase("plant.ending", "the plant is ending")
BUSY = Phrase("cell.busy", "{cell} is busy")
STANDS = Phrase("cell.stands", "{cell} is {state}; {next}")
STANDS_BECAUSE = Phrase("cell.stands_because", "{cell} is {state} ({why}); {next}")
HELD = Phrase("cell.held", "{cell} is held ({why}); {next}")
HELD_STRANDED = Phrase("cell.held_stranded", "{cell} is held ({why}); {stranded}: {next}")
BY_OPERATOR = Phrase("cell.by_operator", "by the operator")
STOPPED = Phrase("cell.stopped", "{cell} was stopped by the operator")
QUEUE_PAUSED = Phrase("cell.queue_paused", "the queue of {cell} is paused; resume {cell} starts it")
LEFT_OVER = Phrase(
    "cell.left_over", "{number:,} tasks of an earlier start wait in {cell}; resume {cell} starts them"
)
LEFT_OVER_ONE = Phrase(
    "cell.left_over_one", "{number} task of an earlier start waits in {cell}; resume {cell} starts it"
)
ABANDONED = Phrase("task.abandoned", "abandoned by the operator")
ASKED_TO_END = Phrase("task.plant_ends", "the plant was asked to end")
NO_CAUSE = Phrase("cell.no_cause", "{cell} failed without a cause")
STOP_UNCONFIRMED = Phrase("cell.stop_unconfirmed", "{robots} did not confirm the stop")
STILL_ASKED = Phrase("robot.still_asked", "{person} has a question to answer first")
STILL_DOING = Phrase("robot.still_doing", "{robot} is still {doing}")
MAY_HOLD = Phrase("part.may_hold", "{arm} may hold a part, its effector is {grip}")
MAY_HOLD_BY_FACT = Phrase("part.may_hold_by_fact", "{device} may hold a part: {fact} is {grip}")
WAS_AT_WORK = Phrase("walk.at_work", "task {task} was at work when the plant stopped")
STANDS_AT = Phrase("walk.stands_at", 'task {task} was at work when the plant stopped; it stands at "{step}"')
FOUND = Phrase(
    "walk.found",
    "{cell}: {found}; resume {cell} goes on if its devices prove what they did, abandon {cell} gives it up",
)
FOUND_STRANDED = Phrase("walk.found_stranded", "{cell}: {found}; {why}; abandon {cell} gives it up")
NOT_YET = Phrase("walk.not_yet", "{why}; until then nobody can tell what became of the step of {cell}")
LET_GO = Phrase("part.let_go", "{arm} let go of its part on the operator's word")
HOMED_MEANWHILE = Phrase("cell.homed_meanwhile", "{arm} was homed meanwhile")
HELD_AS = {
    Grip.OFF: Phrase("held_as.off", "false"),
    Grip.ON: Phrase("held_as.on", "true"),
    Grip.SWITCHING: Phrase("held_as.switching", "not known yet"),
}
GRIPS = {grip: Phrase(f"grip.{grip.value}", grip.value) for grip in Grip}
WAIT = Phrase("next.wait", "wait")
UNTIL_STILL = Phrase("next.until_still", "wait until it stands still")
NEXT = {
    CellState.HOLDING: UNTIL_STILL,
    CellState.ABORTING: UNTIL_STILL,
    CellState.CLEARING: Phrase("next.until_cleared", "wait until its robots have left their stop"),
    CellState.RESETTING: WAIT,
}

WAITS: dict[CellState, Callable[[CellRun], bool]] = {
    CellState.HOLDING: CellRun._halted,
    CellState.ABORTING: CellRun._aborted,
    CellState.CLEARING: CellRun._cleared,
    CellState.IDLE: CellRun._found_unsettled,
    CellState.HELD: CellRun._settled,
}
