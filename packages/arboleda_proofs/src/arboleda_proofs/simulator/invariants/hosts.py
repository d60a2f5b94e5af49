"""Invariants of a plant that has a leader and a standby."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ..recorded.leaders import may_follow
from .invariant import Invariant, Look, Trigger, invariant


@invariant(Trigger.FORMER)
def one_leader_at_a_time(look: Look) -> Iterator[str]:
    """Nothing leaves a process that another one has superseded, but the stops of one that cannot find out."""
    for said in look.moment.former:
        if not may_follow(said):
            yield f"who led under number {said.epoch}, and does no more, sends {said.message}"


@invariant(Trigger.SURE_TOO_LONG)
def a_lead_is_over_before_the_next_begins(look: Look) -> Iterable[str]:
    """Each process that led before knows that it may be superseded once another begins to lead."""
    assert look.leaders is not None
    return look.leaders.sure


@invariant(Trigger.LED_TWICE)
def each_number_is_led_once(look: Look) -> Iterable[str]:
    """A number under which the plant is led belongs to one process, and is higher than any before."""
    assert look.leaders is not None
    return look.leaders.twice


@invariant(Trigger.OLD_NUMBER)
def old_numbers_have_no_effect(look: Look) -> Iterable[str]:
    """A board that knows a number, by a beat or a command, carries out nothing of a lower one but stops."""
    assert look.leaders is not None
    return look.leaders.old


@invariant(Trigger.WRONG_HISTORY)
def history_is_one(look: Look) -> Iterable[str]:
    """Only who leads writes; a task is accepted once and ends once; who starts finds all that was taken."""
    assert look.leaders is not None
    return look.leaders.wrong


HOSTS: tuple[Invariant, ...] = (
    one_leader_at_a_time,
    a_lead_is_over_before_the_next_begins,
    each_number_is_led_once,
    old_numbers_have_no_effect,
    history_is_one,
)
