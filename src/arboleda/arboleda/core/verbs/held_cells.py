"""Verbs that hold a cell or get a held cell going: hold, resume, retry and abandon."""

from __future__ import annotations

from functools import reduce

from arboleda.model.advice import ADVISE, AND
from arboleda.model.cell_states import Cause, CellState
from arboleda.model.messages import Failure, Reason, Verb
from arboleda.model.sentence import Phrase, Sentence

from .. import reasons
from ..cell import CellRun
from .cell_by_cell import in_states

NOT_AT_WORK = Phrase("refusal.not_at_work", "{cell} is {state}; only a cell at work can be held")
QUEUE_RUNS = Phrase("refusal.queue_runs", "{cell} is idle and its queue runs")
ONLY_HELD = Phrase(
    "refusal.only_held", "{cell} is {state}; only a held cell or a paused queue can be resumed"
)
NO_FAULT = Phrase("refusal.no_fault", "{cell} is held without a fault; resume {cell} goes on")
RELEASE_FIRST = Phrase("refusal.release_first", "{arm} may hold a part; release {arm} first")
RELEASE_ALL_FIRST = Phrase("refusal.release_all_first", "{devices} may each hold a part; {releases} first")
NOT_YET = Phrase("walk.not_yet", "{why}; until then nobody can tell what became of the step of {cell}")
ABANDONED = Phrase("task.abandoned", "abandoned by the operator")

_held = in_states(CellState.HELD)


def hold(cell: CellRun, robots: frozenset[str]) -> None:
    """Halt at once, and keep the task at its step for `resume`."""
    cell.halt(Cause.HOLD)


def resume(cell: CellRun, robots: frozenset[str]) -> None:
    """Go on where the cell was held, with each interrupted step given anew; let the queue run."""
    if cell.state is CellState.HELD:
        cell.go_on(Cause.RESUME)
    cell.queue.resume()


def retry(cell: CellRun, robots: frozenset[str]) -> None:
    """Give the failed step anew; without a task, recover anew."""
    if cell.task is not None:
        cell.task.attempts += 1
        cell.go_on(Cause.RETRY)
    else:
        cell.become(Cause.RETRY)
        cell.context.start_afresh()
        cell.recover(anew=True)


def abandon(cell: CellRun, robots: frozenset[str]) -> None:
    """Give the task up and recover; without a task, leave the cell as it is."""
    if cell.task is None:
        cell.leave_as_it_is()
        return
    cell.become(Cause.ABANDON)
    given_up = Failure(reason=Reason.CANCELLED, sentence=ABANDONED())
    if cell.keeping.walk is not None and cell.stranded is not None:
        given_up = Failure(reason=Reason.INTERRUPTED, sentence=cell.stranded)
    cell.task.fail(cell.trouble or given_up)
    cell.recover()


def not_holdable(cell: CellRun, robots: frozenset[str]) -> Sentence | None:
    """The reason why a cell cannot be held."""
    if cell.state is CellState.EXECUTE:
        return None
    return NOT_AT_WORK(cell=cell.cell.name, state=cell.state.sentence)


def not_resumable(cell: CellRun, robots: frozenset[str]) -> Sentence | None:
    """The reason why neither the task nor the queue of a cell can go on."""
    if cell.manual.teaching is not None:
        return cell.manual.teaching.sentence
    if cell.state is CellState.IDLE:
        return None if cell.queue.paused else QUEUE_RUNS(cell=cell.cell.name)
    if cell.state is not CellState.HELD:
        return ONLY_HELD(cell=cell.cell.name, state=cell.state.sentence)
    if cell.task is None or cell.trouble is not None or cell.stranded:
        return reasons.of_hold(cell)
    return _not_yet(cell)


def not_retryable(cell: CellRun, robots: frozenset[str]) -> Sentence | None:
    """The reason why the failed step of a cell cannot be given anew."""
    if cell.manual.teaching is not None:
        return cell.manual.teaching.sentence
    refusal = _held(cell, robots)
    if refusal is None and cell.stranded:
        return reasons.of_hold(cell)
    if refusal is None and cell.task is not None and cell.trouble is None:
        return NO_FAULT(cell=cell.cell.name)
    return refusal or _not_yet(cell)


def not_abandonable(cell: CellRun, robots: frozenset[str]) -> Sentence | None:
    """The reason why a held cell cannot give up what it does."""
    if cell.manual.teaching is not None:
        return cell.manual.teaching.sentence
    refusal = _held(cell, robots)
    if refusal is None and cell.task is None and (holding := cell.context.parts.holding):
        return _release_first(holding)
    return refusal


def _not_yet(cell: CellRun) -> Sentence | None:
    """The sentence that a task of an earlier start cannot be judged yet; None where it can."""
    return None if cell.awaits is None else NOT_YET(cell=cell.cell.name, why=cell.awaits)


def _release_first(holding: list[str]) -> Sentence:
    if len(holding) == 1:
        return RELEASE_FIRST(arm=holding[0])
    releases = [ADVISE[Verb.RELEASE](scope=robot) for robot in holding]
    all_releases = reduce(lambda first, second: AND(first=first, second=second), releases)
    return RELEASE_ALL_FIRST(devices=tuple(holding), releases=all_releases)
