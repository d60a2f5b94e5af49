"""Work that was given up before its device took it may still come: its halt comes after it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import pytest

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.model.commands import FRESH_S, Stop, StopMode
from arboleda.model.messages import Failure, MotionState, Reason, Report
from arboleda.trees.interlocks import Interlocks

from ..kinds.test_interlocks import with_mill

GIVEN_AT, PERIOD_S = 10.0, 0.1
OPEN = (("door", "open"),)


class Floor:
    """A mill at rest that is told to close its door; the zone is free while that is open."""

    def __init__(self) -> None:
        model = with_mill()
        self.dispatcher = Dispatcher(model, 7, {})
        self.dispatcher.limits.timings["tending"] = replace(model.timing, stop_timeout_s=0.05)
        self.now = GIVEN_AT
        self.hear(boot_id=3)
        close = partial(model.robots["mill"].verb_command, "close", ())
        self.entry = self.dispatcher.send(close, "tending", "closing", self.now)

    def hear(self, state: MotionState = MotionState.STOPPED, **said: Any) -> None:
        report = Report(at=self.now, robot="mill", state=state, facts=OPEN, **said)
        self.dispatcher.report(report, self.now)
        self.dispatcher.expire(self.now, self.now)

    def rests(self, until: float, **said: Any) -> None:
        while self.now < until - PERIOD_S / 2:
            self.now += PERIOD_S
            self.hear(**said)

    @property
    def is_occupied(self) -> bool:
        (cell,) = self.dispatcher.model.cells
        return "vise" in Interlocks(cell, self.dispatcher).occupied_by("mill")


def overdue(floor: Floor) -> None:
    floor.entry.deadline = GIVEN_AT
    floor.dispatcher.ledger.plan(floor.entry)
    floor.dispatcher.expire(floor.now, floor.now)


def not_seen_to_stop(floor: Floor) -> None:
    floor.dispatcher.cancel(floor.entry, floor.now)
    floor.now += PERIOD_S
    floor.dispatcher.expire(floor.now, floor.now)


def broken_down(floor: Floor) -> None:
    failure = Failure(reason=Reason.INTERNAL, sentence="it broke")
    floor.dispatcher.booking.give_up("tending", failure, floor.now)


def stopped_by_somebody(floor: Floor) -> None:
    floor.hear(MotionState.STOP_LATCHED)


def in_fault(floor: Floor) -> None:
    floor.hear(MotionState.FAULT)


WAYS = [overdue, not_seen_to_stop, broken_down, stopped_by_somebody, in_fault]


@pytest.mark.parametrize("gives_up", WAYS)
def test_its_device_keeps_the_zone_as_long_as_it_may_come(gives_up: Callable[[Floor], None]) -> None:
    floor = Floor()
    gives_up(floor)
    assert not floor.entry.open
    floor.rests(GIVEN_AT + FRESH_S - PERIOD_S)
    assert floor.is_occupied
    floor.rests(GIVEN_AT + FRESH_S + 2 * PERIOD_S)
    assert not floor.is_occupied


def test_work_that_its_device_took_and_was_halted_keeps_no_zone() -> None:
    floor = Floor()
    floor.hear(MotionState.MOVING, accepted=floor.entry.command.id)
    overdue(floor)
    assert [each.mode for each in floor.dispatcher.outbox if isinstance(each, Stop)] == [StopMode.HALT]
    assert floor.is_occupied, "it moves"
    floor.hear(accepted=floor.entry.command.id)
    assert not floor.is_occupied


@pytest.mark.parametrize("says", [{"boot_id": 4}, {"rejected": "7-1", "refusal": "tarde"}], ids=str)
def test_work_that_will_not_come_keeps_no_zone(says: dict[str, Any]) -> None:
    floor = Floor()
    floor.hear(**says)
    assert not floor.entry.open
    assert not floor.is_occupied
