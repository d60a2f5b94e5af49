"""Mutants for tasks and cells, for liveness and for books."""

from __future__ import annotations

from arboleda.core.cell import CellRun
from arboleda.core.cell_steps import _aborted, _halted
from arboleda.core.choosing import best
from arboleda.core.operator import Operator
from arboleda.core.plant import Plant
from arboleda.core.task_desk import TaskDesk
from arboleda.core.verbs.cancelling import Cancelling
from arboleda.core.verbs.held_cells import resume
from arboleda.dispatch import evidence
from arboleda.dispatch.latches import Latches
from arboleda.trees import paths, steps
from arboleda.trees.cell_time import CellTime
from arboleda.trees.leaves import Dwell, TakeZones
from arboleda.trees.tree_run import TreeRun
from arboleda.wire import strict
from arboleda_proofs.simulator.run import NO_EXCEPTION

from .mutant import SHARED, edit, mutant

BEAT = """if now >= self._next_beat:  # 8
        self._next_beat = now + HEARTBEAT_S
        self.dispatcher.outbox.append(Heartbeat(epoch=self.epoch))
    self._due = None"""
COLLECT = "out = self.dispatcher.outbox.copy()\n    self.dispatcher.outbox.clear()"
STAYS_SHORT = (
    " or at < observed.stopped_since + QUIET_S:\n"
    "        return False\n"
    "    if not entry.positions:\n"
    "        return True\n"
    "    if belief.position == entry.origin:\n"
    "        return False  # a robot that never left may have told the end of an earlier move\n"
    "    return belief"
)
PATIENCE_S = 60.0  # enough for what comes to rest at all

TASKS = (
    mutant(
        "each_task_ends_once",
        "That a task ended is told twice.",
        edit(CellRun._finish, "self._changed(task)", "self._changed(task); self._changed(task)"),
        weather="none",
    ),
    mutant(
        "nothing_of_an_ended_task_moves",
        "A task that is cancelled ends at once, and goes on with its work.",
        edit(
            CellRun.cancel,
            "if held or not self.run.recovering:\n        self.recover()",
            "if self.task is not None:\n        self._finish(self.task, TaskState.CANCELLED)",
        ),
        weather={"operator_cancel": 20.0},
    ),
    mutant(
        "ended_tasks_stay_ended",
        "To cancel a task that has ended is not refused.",
        edit(
            Cancelling._planned_cancel,
            "raise VerbRefusal(TASK_ENDED(task=id, state=TASK_STATES[task.state]()))",
            "return lambda: None",
        ),
        weather={"operator_cancel": 30.0},
    ),
    mutant(
        "no_task_fails_without_a_fault",
        'The late "moving, stopped" of an earlier move counts as a stop short of the goal.',
        edit(evidence._stays_short, STAYS_SHORT, ":\n        return False\n    return True or belief"),
        weather="none",
        seeds=SHARED,
        likely=6,
    ),
    mutant(
        "only_legal_task_states",
        "That a task starts is not told.",
        edit(CellRun.start, "    self._changed(task)\n", ""),
        weather="none",
    ),
    mutant(
        "first_come_first_served",
        "The task that came last is the next one.",
        edit(CellRun.advance, "self.queue.popleft()", "self.queue.pop()"),
        weather="none",
    ),
    mutant(
        "tasks_go_to_the_best_cell",
        "Of the cells that a task may go to it goes to the worst.",
        edit(best, "min(prospects", "max(prospects"),
        weather="none",
        any_of=True,
    ),
    mutant(
        "courses_are_as_seen",
        "The time for which a task is held counts as its work.",
        edit(TreeRun.course, "self._context.time.now", "self._context.time.plant_now"),
        weather={"operator_hold": 30.0, "operator_resume": 60.0},
    ),
    mutant(
        "tasks_stay_in_their_cell",
        "A task that begins is said to be in the last cell.",
        edit(
            TaskDesk.tell,
            "cell=task.order.cell,",
            "cell=[*self._state.cells][-1] if task.state is TaskState.RUNNING else task.order.cell,",
        ),
        weather="none",
    ),
    mutant(
        "cancelled_tasks_end_cancelled",
        "A task that is held counts as failed when it is cancelled.",
        edit(CellRun.cancel, "self.cancelling = True", "self.cancelling = self.state is CellState.EXECUTE"),
        weather={"operator_hold": 20.0, "operator_cancel": 40.0},
    ),
    mutant(
        "accepted_tasks_are_kept",
        "A stop empties the queue and tells nobody.",
        edit(CellRun.stop, "self.queue.paused = True", "self.queue.paused = True; self.queue.clear()"),
        weather={"operator_stop": 10.0},
    ),
    mutant(
        "only_legal_cell_states",
        "A stopped cell clears itself once it stands still.",
        edit(
            _aborted,
            "run.become(Cause.HALTED)",
            "run.become(Cause.HALTED); run.become(Cause.CLEAR)",
        ),
        weather={"operator_stop": 10.0},
    ),
    mutant(
        "rejected_input_changes_nothing",
        "An operator's verb is in the journal before anybody knows whether it can be done.",
        edit(
            Operator.act,
            "do = self._planned(request, scope)",
            "early = Journal(verb=request.verb, scope=scope, cell=None, sentence=PLANT())\n"
            "    self._state.dispatcher.outbox.append(early)\n"
            "    do = self._planned(request, scope)",
        ),
    ),
    mutant(
        "every_request_is_answered",
        "An empty task text is passed over.",
        edit(
            TaskDesk.take,
            "self._state.dispatcher.outbox.append(_refused(",
            "if request.text: self._state.dispatcher.outbox.append(_refused(",
        ),
        weather={"bad_task": 30.0},
    ),
    mutant(
        "nothing_moves_after_an_absence",
        "A plant that was away goes on as if it had not been.",
        edit(Plant.step, "if self._steps and away_s > self.away_after_s:", "if False:"),
        weather={"plant_freeze": 6.0},
    ),
    mutant(
        "no_internal_failure",
        "A path is cut where its robot stands, even where nobody knows that.",
        edit(
            paths.follow,
            "if node in nodes:",
            "if nodes:",
        ),
        seeds=SHARED,
        weather={"brown_out": 30.0},
    ),
    mutant(
        "sentences_are_for_people",
        "Who sends a bad task text is told the exception, not its sentence.",
        edit(TaskDesk.take, "refusal.sentence", "Phrase('own', repr(refusal))()"),
        weather={"bad_task": 30.0},
    ),
)

LIVENESS = (
    mutant(
        "running_tree_has_waker",
        "A dwell does not ask to be woken.",
        edit(Dwell.initialise, "self.time.wake_at(self.until)", ""),
        weather="none",
    ),
    mutant(
        "time_stands_still_only_when_held",
        "A cell that is stopped while it is held never gets its time back.",
        edit(CellRun.stop, "self.context.time.go_on()", ""),
        weather={"operator_hold": 5.0, "operator_stop": 5.0},
    ),
    mutant(
        "time_stands_still_where_held",
        "The time of a cell goes on while it is held.",
        edit(CellTime.pause, "if self._paused_at is None:", "if self._paused_at is not None:"),
        weather={"operator_hold": 10.0},
    ),
    mutant(
        "held_cells_stand_still",
        "A cell counts as held while its robots still move.",
        edit(_halted, "if any(entry.halts", "if False and any(entry.halts"),
        weather={"operator_hold": 10.0},
    ),
    mutant(
        "low_robots_rise_first",
        "A recovery goes home from where the robot stands.",
        edit(steps._way_home, "*_rise(context, robot)", ""),
        seeds=SHARED,
        weather={"operator_cancel": 10.0},
    ),
    mutant(
        "no_tree_outlives_its_work",
        "A stop leaves the tree where it was.",
        edit(CellRun.interrupt, "self.run.drop()", ""),
        weather={"operator_stop": 10.0},
    ),
    mutant(
        "no_starvation",
        "An idle cell looks into its queue only when something else changed.",
        edit(
            CellRun.advance,
            "if may_begin and self.state is CellState.IDLE",
            "if self.dirty and may_begin and self.state is CellState.IDLE",
        ),
        weather="none",
    ),
    mutant(
        "zone_requests_end",
        "An arm waits for its zones twice as long as it may.",
        edit(
            TakeZones.initialise,
            "super().initialise()",
            "super().initialise()\n        self.until += self.seconds",
        ),
        seeds=SHARED,
        weather={"brown_out": 20.0},
    ),
    mutant(
        "at_rest_at_end",
        "To clear a stop is not sent to the robot.",
        edit(Latches.unlatch, "self._outlet.stop(robot, StopMode.CLEAR)", ""),
        weather={"operator_stop": 5.0},
        rest_s=PATIENCE_S,
    ),
    mutant(
        "nothing_waits_at_end",
        "To resume an idle cell does not let its queue run.",
        edit(
            resume,
            "    cell.queue.resume()",
            "        cell.queue.resume()",
        ),
        weather={"operator_stop": 5.0},
        rest_s=PATIENCE_S,
    ),
)

BOOKS = (
    mutant(
        "bounded_books",
        "A step beats after it has collected what must go out.",
        edit(
            Plant.step,
            f"{BEAT}\n    {COLLECT}",
            f"{COLLECT}\n    {BEAT}",
        ),
        weather="none",
    ),
    mutant(
        NO_EXCEPTION,
        "A text is compared as if it was a number.",
        edit(strict.integer, "if type(value) is not int:", "if value is None:"),
        weather={"foreign_garbage": 30.0},
    ),
)

CELLS = (*TASKS, *LIVENESS, *BOOKS)
