"""What follows for a robot from the end of a command."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import pytest

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.evidence import CommandVerdict
from arboleda.dispatch.ledger import Entry, Feed, State
from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Stop, StopMode
from arboleda.model.messages import Failure, Reason, Report
from arboleda.model.refusals import STOPPED
from arboleda.model.sentence import OWN

from .test_dispatcher import dispatcher as dispatcher

SWITCH = partial(SetEffector, robot="ra1", on=True)


def moving(dispatcher: Dispatcher) -> Entry:
    return dispatcher.send(partial(MoveJoints, robot="ra1", q=(0.5, 0.0, 0.0)), "sis_a", "moving", 100.1)


def verdict(feed: Feed, reason: Reason, said: str = "it failed") -> CommandVerdict:
    return CommandVerdict(feed=feed, failure=Failure(reason=reason, sentence=OWN(text=said)))


@pytest.mark.parametrize(
    ("reason", "is_halted"),
    [
        (Reason.DEADLINE, True),
        (Reason.LINK_LOST, True),
        (Reason.STOPPED, False),
        (Reason.STOPPED_SHORT, False),
    ],
    ids=lambda value: value.value if isinstance(value, Reason) else None,
)
def test_a_robot_whose_move_failed_is_halted_but_where_it_is_known_to_stand(
    dispatcher: Dispatcher, reason: Reason, *, is_halted: bool
) -> None:
    dispatcher.booking.book(moving(dispatcher), verdict(Feed.FAILED, reason), 100.2)
    stops = [each.mode for each in dispatcher.outbox if isinstance(each, Stop)]
    assert stops == [StopMode.HALT] * is_halted


def test_refusals_are_counted_with_the_last_reason(dispatcher: Dispatcher) -> None:
    for said in ("no reference", "a door is open"):
        dispatcher.booking.book(moving(dispatcher), verdict(Feed.REJECTED, Reason.REJECTED, said), 100.2)
    assert dispatcher.booking.rejected == {"ra1": (2, OWN(text="a door is open"))}
    assert not dispatcher.beliefs["ra1"].barred


def test_who_refuses_for_a_stop_that_it_does_not_report_takes_no_other_command(
    dispatcher: Dispatcher,
) -> None:
    dispatcher.booking.book(moving(dispatcher), verdict(Feed.REJECTED, Reason.STOPPED), 100.2)
    obstacle = dispatcher.beliefs["ra1"].obstacle(was=False)
    assert obstacle is not None and obstacle.reason is Reason.STOPPED


def test_so_does_who_refuses_what_its_facts_had_proven_and_its_refusal_counts_once(
    dispatcher: Dispatcher,
) -> None:
    switch, belief = dispatcher.send(SWITCH, "sis_a", "gripping", 100.1), dispatcher.beliefs["ra1"]
    dispatcher.booking.book(switch, CommandVerdict(feed=Feed.DONE), 100.2)
    refused = Report(at=100.3, robot="ra1", rejected=switch.command.id, refusal=STOPPED)
    dispatcher.report(refused, 100.3)
    obstacle = belief.obstacle(was=False)
    assert obstacle is not None and obstacle.reason is Reason.STOPPED
    belief.barred = False
    dispatcher.report(replace(refused, at=100.6), 100.6)
    assert not belief.barred


def test_the_fact_of_a_failed_switch_is_doubted_until_another_one_is_done(dispatcher: Dispatcher) -> None:
    booking = dispatcher.booking
    switch = dispatcher.send(SWITCH, "sis_a", "gripping", 100.1)
    booking.book(switch, verdict(Feed.FAILED, Reason.DEADLINE), 101.0)
    assert booking.doubtful == {"ra1": {"effector"}}
    booking.book(dispatcher.send(SWITCH, "sis_a", "gripping", 101.1), CommandVerdict(feed=Feed.DONE), 101.5)
    assert booking.doubtful == {"ra1": set()}


def test_a_failure_that_somebody_else_may_have_caused_says_so(dispatcher: Dispatcher) -> None:
    move = moving(dispatcher)
    move.interference = OWN(text="somebody else moved it")
    dispatcher.booking.book(move, verdict(Feed.FAILED, Reason.DEADLINE, "it is late"), 100.2)
    assert move.failure is not None
    assert all(each in str(move.failure.sentence) for each in ("it is late", "somebody else moved it"))


@pytest.mark.parametrize("cancelled", [False, True])
def test_what_nobody_can_judge_any_more_has_failed(dispatcher: Dispatcher, *, cancelled: bool) -> None:
    move = dispatcher.send(partial(MoveJoints, robot="ra1", q=(0.5, 0.0, 0.0)), "sis_a", "moving", 100.1)
    if cancelled:
        dispatcher.cancel(move, 100.2)
    dispatcher.booking.give_up("sis_a", Failure(reason=Reason.INTERNAL, sentence="it broke"), 100.3)
    assert move.state is State.FAILED and move.failure and move.failure.reason is Reason.INTERNAL


@pytest.mark.parametrize("cancelled", [False, True])
def test_what_did_not_leave_has_failed_or_has_ended_as_it_was_told_to(
    dispatcher: Dispatcher, *, cancelled: bool
) -> None:
    move = dispatcher.send(partial(MoveJoints, robot="ra1", q=(0.5, 0.0, 0.0)), "sis_a", "moving", 100.1)
    if cancelled:
        dispatcher.cancel(move, 100.1)
    dispatcher.booking.undelivered(move.command.id, "ra1", "a stop left before it", 100.2)
    assert move.state is (State.CANCELLED if cancelled else State.FAILED)
