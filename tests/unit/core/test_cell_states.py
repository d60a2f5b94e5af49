"""The table of the cell's states: what is in it, what is reachable, and where an operator is needed."""

from __future__ import annotations

import itertools

import pytest

from arboleda.model.cell_states import TABLE, Cause, CellState, after
from arboleda.model.errors import IllegalTransition

OPERATORS = {Cause.HOLD, Cause.RESUME, Cause.RETRY, Cause.ABANDON, Cause.STOP, Cause.CLEAR, Cause.RESET}
WAIT_FOR_AN_OPERATOR = {CellState.HELD, CellState.ABORTED, CellState.STOPPED}
PAIRS = list(itertools.product(CellState, Cause))


def reachable(start: CellState, causes: set[Cause]) -> set[CellState]:
    found, frontier = {start}, [start]
    while frontier:
        here = frontier.pop()
        steps = {state for (before, cause), state in TABLE.items() if before is here and cause in causes}
        frontier += steps - found
        found |= steps
    return found


@pytest.mark.parametrize(("state", "cause"), PAIRS, ids=lambda word: word.value)
def test_a_pair_follows_the_table_or_is_refused_with_a_sentence(state: CellState, cause: Cause) -> None:
    if (state, cause) in TABLE:
        assert after(state, cause, "sis_a") is TABLE[state, cause]
        return
    with pytest.raises(IllegalTransition, match=f"sis_a is {state.sentence}: no {cause.value} there"):
        after(state, cause, "sis_a")


def test_a_second_clear_waits_as_the_first_one_does() -> None:
    assert after(CellState.CLEARING, Cause.CLEAR, "sis_a") is CellState.CLEARING


def test_every_state_is_reachable_and_none_is_a_dead_end() -> None:
    assert reachable(CellState.IDLE, set(Cause)) == set(CellState)
    assert all(CellState.IDLE in reachable(state, set(Cause)) for state in CellState)


@pytest.mark.parametrize("state", list(CellState), ids=lambda state: state.value)
def test_only_held_aborted_and_stopped_wait_for_an_operator(state: CellState) -> None:
    by_itself = reachable(state, set(Cause) - OPERATORS - {Cause.TASK, Cause.STUCK}) - {state}
    rests = state is CellState.IDLE or state in WAIT_FOR_AN_OPERATOR
    ends = by_itself & (WAIT_FOR_AN_OPERATOR | {CellState.IDLE})
    assert ends or rests


@pytest.mark.parametrize("state", list(CellState), ids=lambda state: state.value)
def test_a_stop_is_taken_in_every_state(state: CellState) -> None:
    assert after(state, Cause.STOP, "sis_a") is CellState.ABORTING


def test_after_a_stop_no_way_leads_to_a_motion_but_over_clear_and_reset() -> None:
    for missing in (Cause.CLEAR, Cause.RESET):
        assert CellState.EXECUTE not in reachable(CellState.ABORTING, set(Cause) - {missing})


def test_every_cause_is_in_the_table() -> None:
    assert {cause for _, cause in TABLE} == set(Cause)
