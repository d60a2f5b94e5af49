"""Refusals of verbs that hold a cell or get a held cell going: hold, resume, retry and abandon."""

from __future__ import annotations

from functools import reduce

from arboleda.model.messages import Verb
from arboleda.model.sentence import Phrase, Sentence

from .. import reasons
from ..advice import AND, DO
from ..cell import NOT_YET, CellRun
from ..cell_states import CellState
from .cell_by_cell import in_states

NOT_AT_WORK = Phrase("refusal.not_at_work", "{cell} is {state}; only a cell at work can be held")
QUEUE_RUNS = Phrase("refusal.queue_runs", "{cell} is idle and its queue runs")
ONLY_HELD = Phrase(
    "refusal.only_held", "{cell} is {state}; only a held cell or a paused queue can be resumed"
)
NO_FAULT = Phrase("refusal.no_fault", "{cell} is held without a fault; resume {cell} goes on")
RELEASE_FIRST = Phrase("refusal.release_first", "{arm} may hold a part; release {arm} first")
RELEASE_ALL_FIRST = Phrase("refusal.release_all_first", "{devices} may each hold a part; {releases} first")

_held = in_states(CellState.HELD)


def not_holdable(cell: CellRun, robots: frozenset[str]) -> Sentence | None:
    """Why a cell cannot be held."""
    if cell.state is CellState.EXECUTE:
        return None
    return NOT_AT_WORK(cell=cell.cell.name, state=cell.state.sentence)


def not_resumable(cell: CellRun, robots: frozenset[str]) -> Sentence | None:
    """Why neither the task nor the queue of a cell can go on."""
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
    """Why the step of a cell that failed cannot be given anew."""
    if cell.manual.teaching is not None:
        return cell.manual.teaching.sentence
    refusal = _held(cell, robots)
    if refusal is None and cell.stranded:
        return reasons.of_hold(cell)
    if refusal is None and cell.task is not None and cell.trouble is None:
        return NO_FAULT(cell=cell.cell.name)
    return refusal or _not_yet(cell)


def not_abandonable(cell: CellRun, robots: frozenset[str]) -> Sentence | None:
    """Why a held cell cannot give up what it does."""
    if cell.manual.teaching is not None:
        return cell.manual.teaching.sentence
    refusal = _held(cell, robots)
    if refusal is None and cell.task is None and (holding := cell.context.parts.holding):
        return _release_first(holding)
    return refusal


def _not_yet(cell: CellRun) -> Sentence | None:
    """That a task of an earlier start cannot be judged yet."""
    return None if cell.awaits is None else NOT_YET(cell=cell.cell.name, why=cell.awaits)


def _release_first(holding: list[str]) -> Sentence:
    """That parts are to be released first, by everybody that may hold one."""
    if len(holding) == 1:
        return RELEASE_FIRST(arm=holding[0])
    releases = [DO[Verb.RELEASE](scope=robot) for robot in holding]
    all_releases = reduce(lambda first, second: AND(first=first, second=second), releases)
    return RELEASE_ALL_FIRST(devices=tuple(holding), releases=all_releases)
