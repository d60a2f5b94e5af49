"""Follower of advice: does nothing but the first of it, until a cell works."""

from __future__ import annotations

from arboleda.engine import why_waiting
from arboleda.model.advice import Advice, Hand, in_words
from arboleda.model.cell_states import CellState
from arboleda.rig.hands import do
from arboleda.testing import Rig

ENOUGH = 9  # acts that lead out of any state: two cells cleared and reset, a home, three questions, resume
SOON_S, PATIENCE_S = 2.0, 60.0


def works(rig: Rig, cell: str) -> bool:
    """True if a cell would start a task, or has started the next one."""
    run = rig.plant.cells[cell]
    return run.state is CellState.IDLE and run.not_ready is None


def advised(rig: Rig, cell: str) -> list[str]:
    """The advice in words, in order."""
    return [str(in_words(each)) for each in rig.plant.advice(cell)]


def follow(rig: Rig, cell: str) -> list[str]:
    """Do the first of the advice again and again until the cell works; return what was done, in words."""
    done: list[str] = []
    while not _comes_to_work(rig, cell):
        ways = rig.plant.advice(cell)
        assert ways, f"after {done} nothing is advised: {why_waiting(rig.plant.cells[cell])}"
        assert len(done) < ENOUGH, f"{done} lead nowhere: {why_waiting(rig.plant.cells[cell])}"
        for each in _next_steps(ways):
            done.append(str(in_words(each)))
            assert each.refusal is None, f"{done[-1]} is advised first and refused: {each.refusal}"
            answers = len(rig.answers)
            do(rig, each)
            rig.wait(SOON_S)
            refused = [answer for answer in rig.answers[answers:] if answer.refusal is not None]
            assert not refused or _is_reported_already(rig, cell, each), refused[-1]
    return done


def _is_reported_already(rig: Rig, cell: str, advice: Advice) -> bool:
    """True if a device had reported what was done by hand before anybody said so."""
    return advice.by_hand and advice not in rig.plant.advice(cell)


def _next_steps(ways: tuple[Advice, ...]) -> tuple[Advice, ...]:
    """The advice to follow now: the first, and after a look into a zone the next, that it is empty."""
    return ways[:2] if ways[0].do is Hand.CHECK else ways[:1]


def _comes_to_work(rig: Rig, cell: str) -> bool:
    rig.wait(PATIENCE_S, until=lambda: works(rig, cell) or _can_be_done(rig.plant.advice(cell)))
    return works(rig, cell)


def _can_be_done(ways: tuple[Advice, ...]) -> bool:
    """True if the first of the advice can be done now; some can only once an arm has left a zone."""
    return bool(ways) and ways[0].refusal is None
