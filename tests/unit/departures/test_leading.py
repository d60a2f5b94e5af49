"""The rules by which processes of several hosts know who leads."""

from __future__ import annotations

import pytest

from arboleda.departures.leading import (
    LEASE_S,
    SURE_S,
    Lease,
    Silence,
    Standing,
    all_stand,
    at_work,
    may_leave,
)
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Home, Stop, StopMode
from arboleda.model.messages import Heartbeat

MOVE = Home(id="1-1", robot="ra1")
HALT = Stop(id="1-2", robot="ra1", mode=StopMode.HALT)
BEAT = Heartbeat(epoch=1)


def test_a_lease_that_nobody_gave_does_not_last() -> None:
    assert not Lease().lasts(0.0)


def test_a_lease_counts_from_when_it_was_asked_for_and_ends_before_that_of_the_store() -> None:
    lease = Lease()
    lease.renewed(10.0)
    assert lease.lasts(10.0 + SURE_S - 0.001) and not lease.lasts(10.0 + SURE_S)
    assert SURE_S < LEASE_S


@pytest.mark.parametrize("slower", [1.0, 0.99, 0.965])
def test_a_clock_that_is_slower_finds_its_lease_over_before_anybody_else_may_lead(slower: float) -> None:
    lease = Lease()
    lease.renewed(0.0)
    faster = 2.0 - slower
    assert not lease.lasts(slower * LEASE_S / faster)


@pytest.mark.parametrize("hours", [0.0, 1.0, -1.0], ids=["right", "an hour on", "an hour back"])
def test_a_lease_ends_by_the_clock_of_who_waits_wherever_that_of_the_store_is_set(hours: float) -> None:
    silence = Silence()
    assert not silence.ends_lease(10.0, (7, 500.0))
    assert not silence.ends_lease(12.0, (7, 502.0 + 3600.0 * hours))  # he has said something
    assert not silence.ends_lease(12.0 + LEASE_S - 0.01, (7, 502.0 + 3600.0 * hours))
    assert silence.ends_lease(12.0 + LEASE_S, (7, 502.0 + 3600.0 * hours))


@pytest.mark.parametrize(
    ("standing", "leaves"),
    [
        (Standing.LEADS, [True, True, True]),
        (Standing.UNSURE, [False, True, True]),
        (Standing.SUPERSEDED, [False, False, False]),
    ],
)
def test_who_is_unsure_only_stops_and_who_was_superseded_says_nothing(
    standing: Standing, leaves: list[bool]
) -> None:
    assert [may_leave(each, standing) for each in (MOVE, HALT, BEAT)] == leaves


def test_a_planned_change_holds_what_is_at_work_and_waits_until_it_stands() -> None:
    states = {"a": CellState.EXECUTE, "b": CellState.IDLE, "c": CellState.HOLDING}
    assert at_work(states) == ["a"]
    assert all_stand({**states, "a": CellState.HELD}, ["a"])
    assert not all_stand(states, ["c"])
