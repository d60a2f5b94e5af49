"""States of a cell, and the causes that change them, in the words of PackML (ISA-TR88.00.02).

The stop (software) is the abort of PackML. It is not a safety function.
"""

from __future__ import annotations

from enum import Enum

from arboleda.model.errors import IllegalTransition
from arboleda.model.sentence import Phrase, Sentence


class CellState(str, Enum):
    """State of a cell; the value is its word on every screen and in every document."""

    IDLE = "idle"
    EXECUTE = "execute"
    HOLDING = "holding"
    HELD = "held"
    ABORTING = "aborting"
    ABORTED = "aborted"
    CLEARING = "clearing"
    STOPPED = "stopped"
    RESETTING = "resetting"

    @property
    def sentence(self) -> Sentence:
        """The word as it stands in a sentence, after "the cell is"."""
        return SAID[self]


SAID = {
    state: Phrase(
        f"state.{state.value}", f"in {state.value}" if state is CellState.EXECUTE else state.value
    )()
    for state in CellState
}


class Cause(str, Enum):
    """Cause for which a cell changes its state.

    `stuck` is a recovery that failed, a part in the effector of an idle arm, or a defect. `away` is an
    absence of the plant: a suspend of its machine, or its end while a task was at work.
    """

    TASK = "task"
    ENDED = "ended"
    STUCK = "stuck"
    HOLD = "hold"
    AWAY = "away"
    HALTED = "halted"
    RESUME = "resume"
    RETRY = "retry"
    ABANDON = "abandon"
    STOP = "stop"
    CLEAR = "clear"
    CLEARED = "cleared"
    RESET = "reset"
    READY = "ready"


NO_WAY = Phrase("cell.no_way", "{cell} is {state}: no {cause} there")
TABLE: dict[tuple[CellState, Cause], CellState] = {
    (CellState.IDLE, Cause.TASK): CellState.EXECUTE,
    (CellState.IDLE, Cause.STUCK): CellState.HELD,
    (CellState.IDLE, Cause.AWAY): CellState.HELD,
    (CellState.EXECUTE, Cause.ENDED): CellState.IDLE,
    (CellState.EXECUTE, Cause.STUCK): CellState.HELD,
    (CellState.EXECUTE, Cause.HOLD): CellState.HOLDING,
    (CellState.EXECUTE, Cause.AWAY): CellState.HOLDING,
    (CellState.HOLDING, Cause.HALTED): CellState.HELD,
    (CellState.HOLDING, Cause.STUCK): CellState.HELD,
    (CellState.HELD, Cause.RESUME): CellState.EXECUTE,
    (CellState.HELD, Cause.RETRY): CellState.EXECUTE,
    (CellState.HELD, Cause.ABANDON): CellState.EXECUTE,
    (CellState.HELD, Cause.ENDED): CellState.IDLE,
    (CellState.HELD, Cause.STUCK): CellState.HELD,
    (CellState.ABORTING, Cause.HALTED): CellState.ABORTED,
    (CellState.ABORTED, Cause.CLEAR): CellState.CLEARING,
    (CellState.CLEARING, Cause.CLEAR): CellState.CLEARING,
    (CellState.CLEARING, Cause.CLEARED): CellState.STOPPED,
    (CellState.STOPPED, Cause.RESET): CellState.RESETTING,
    (CellState.RESETTING, Cause.READY): CellState.IDLE,
    **{(state, Cause.STOP): CellState.ABORTING for state in CellState},
}


def after(state: CellState, cause: Cause, cell: str) -> CellState:
    """The next state; IllegalTransition where the table has no row."""
    following = TABLE.get((state, cause))
    if following is None:
        raise IllegalTransition(NO_WAY(cell=cell, state=state.sentence, cause=cause.value))
    return following
