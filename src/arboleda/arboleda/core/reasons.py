"""Reasons why a cell stands still, and what to do about them, for operators."""

from __future__ import annotations

from arboleda.model import advice
from arboleda.model.cell_states import CellState
from arboleda.model.sentence import BOTH, Phrase, Sentence
from arboleda.trees.tree_run import step_of

from .cell import STOPPED, CellRun

ENDING = Phrase("plant.ending", "the plant is ending")
RESTARTS = Phrase(
    "plant.restarts", "the plant restarts once all its cells rest; until then no other task begins"
)
BUSY = Phrase("cell.busy", "{cell} is busy")
BUSY_PAUSED = Phrase(
    "cell.busy_paused", "{cell} is busy, and its queue is paused; once it is idle, resume {cell} starts it"
)
STANDS = Phrase("cell.stands", "{cell} is {state}; {next}")
STANDS_BECAUSE = Phrase("cell.stands_because", "{cell} is {state} ({why}); {next}")
HELD = Phrase("cell.held", "{cell} is held ({why}); {next}")
HELD_STRANDED = Phrase("cell.held_stranded", "{cell} is held ({why}); {stranded}: {next}")
BY_OPERATOR = Phrase("cell.by_operator", "by the operator")
"""Reason of a hold where nothing is wrong."""
WAS_AT_WORK = Phrase("walk.at_work", "task {task} was at work when the plant stopped")
AT_STEP = Phrase("walk.stands_at", 'task {task} was at work when the plant stopped, at its step "{step}"')
WAIT = Phrase("next.wait", "wait")
UNTIL_STILL = Phrase("next.until_still", "wait until it stands still")
NEXT = {
    CellState.HOLDING: UNTIL_STILL,
    CellState.ABORTING: UNTIL_STILL,
    CellState.CLEARING: Phrase("next.until_cleared", "wait until its robots have left their stop"),
    CellState.RESETTING: WAIT,
}


def of_waiting(run: CellRun) -> Sentence | None:
    """The reason why the next task does not start; None where nothing is in its way."""
    name = run.cell.name
    if run.closed:
        return ENDING()
    if run.state is CellState.EXECUTE:
        return (BUSY_PAUSED if run.queue.paused else BUSY)(cell=name)
    if run.state is CellState.IDLE:
        return RESTARTS() if run.queue.awaits_restart else run.not_ready
    if run.trouble is None or run.state is CellState.HELD:
        return of_hold(run) or STANDS(cell=name, state=run.state.sentence, next=_next(run))
    why = run.trouble.sentence
    return STANDS_BECAUSE(cell=name, state=run.state.sentence, why=why, next=_next(run))


def of_hindrance(run: CellRun) -> Sentence | None:
    """The reason why a new task would not start by itself after the tasks before it; None where it would."""
    if run.state is not CellState.EXECUTE:
        return of_waiting(run)
    if run.queue.awaits_restart:
        return RESTARTS()
    if (obstacle := run.readiness.obstacle_at_work()) is not None:
        return obstacle
    return run.queue.why_paused if run.queue.paused else None


def of_hold(run: CellRun) -> Sentence | None:
    """The cause of a hold and what can be done about it; None where the cell is not held."""
    if run.state is not CellState.HELD:
        return None
    name, why, next_steps = run.cell.name, cause_of_hold(run), _next(run)
    if run.stranded:
        return HELD_STRANDED(cell=name, why=why, stranded=run.stranded, next=next_steps)
    return HELD(cell=name, why=why, next=next_steps)


def cause_of_hold(run: CellRun) -> Sentence:
    why = run.trouble.sentence if run.trouble else run.awaits
    if (at_work := _at_work(run)) is None:
        return why or BY_OPERATOR()
    return BOTH(first=at_work, second=why) if why else at_work


def cause_of_stop(run: CellRun) -> Sentence:
    """The cause of a stop, or that it was not confirmed."""
    return run.trouble.sentence if run.trouble else STOPPED(cell=run.cell.name)


def _at_work(run: CellRun) -> Sentence | None:
    """The step at which an earlier start left the task; None once somebody said how the task goes on."""
    if run.keeping.walk is None or run.task is None:
        return None
    step = step_of(run.tree)
    return WAS_AT_WORK(task=run.task.id) if step is None else AT_STEP(task=run.task.id, step=step)


def _next(run: CellRun) -> Sentence:
    if ways_out := advice.sentence(run.ways_out(run.cell.name)):
        return ways_out
    return NEXT[run.state]() if run.state in NEXT else run.readiness.busy() or WAIT()
