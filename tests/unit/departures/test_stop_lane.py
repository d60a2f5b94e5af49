"""Stops that leave beside the plant's steps, and what their askers hear; time is moved by hand."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.core.plant import Plant
from arboleda.departures.leaving import STILL_WAITS, StopLeft, Unkept, departure, done_at_once
from arboleda.departures.stop_lane import (
    ANSWERED_WITHIN_S,
    Blocked,
    Closed,
    Departed,
    Event,
    Happened,
    Opened,
    Overrun,
    StopLane,
)
from arboleda.kinds.arm import SetEffector
from arboleda.model.commands import Home, Stop, StopMode
from arboleda.model.messages import Heartbeat, OperatorAnswer, OperatorRequest, Outcome, Report, Verb
from arboleda.testing import shipped

MODEL = shipped()
EPOCH = 7


@pytest.fixture
def lane() -> StopLane:
    return StopLane(MODEL, epoch=EPOCH)


def opened(scope: str, token: str = "a", at: float = 10.0) -> Opened:
    return Opened(request=OperatorRequest(at=at, verb=Verb.STOP, scope=scope, request=token))


def latched_by_the_plant(scope: str) -> list[str]:
    plant = Plant(MODEL, epoch=EPOCH, now=0.0)
    plant.step(0.0, [])
    said = plant.step(1.0, [OperatorRequest(at=1.0, verb=Verb.STOP, scope=scope)])
    return [each.robot for each in said if isinstance(each, Stop)]


@pytest.mark.parametrize("scope", ["", "plant", "sis_b", "ra1", "rm_sis_c", " SIS_A ", "sis_z"])
def test_it_stops_those_robots_that_the_plant_will_stop(lane: StopLane, scope: str) -> None:
    stops = lane.step(10.0, [opened(scope), Blocked(request_id="a")])
    assert {stop.robot for stop in stops} == set(latched_by_the_plant(scope))
    assert len(stops) == len({stop.robot for stop in stops})
    assert all(stop.mode is StopMode.LATCH for stop in stops)


def test_a_plant_that_is_free_sends_its_stops_itself(lane: StopLane) -> None:
    assert lane.step(10.0, [opened("")]) == []


def test_no_board_takes_one_stop_for_a_repetition_of_another_or_of_a_step(lane: StopLane) -> None:
    stops = [*lane.step(10.0, [opened("ra1"), Blocked(request_id="a")])]
    stops += lane.step(11.0, [opened("ra1", "b"), Blocked(request_id="b"), Overrun(robot="ra1")])
    plant = Plant(MODEL, epoch=EPOCH, now=0.0)
    plant.step(0.0, [])
    ids = [each.id for each in stops if isinstance(each, Stop)]
    for at in (1.0, 2.0):
        said = plant.step(at, [OperatorRequest(at=at, verb=Verb.STOP, scope="ra1")])
        ids += [each.id for each in said if isinstance(each, Stop)]
    assert len(set(ids)) == len(ids) == 5


def test_the_plant_takes_no_number_of_the_lane_for_that_of_a_stranger(lane: StopLane) -> None:
    plant = Plant(MODEL, epoch=EPOCH, now=0.0)
    plant.step(0.0, [])
    for number in range(3):
        at, token = 1.0 + number / 10, str(number)
        (stop,) = lane.step(at, [opened("ra1", token, at), Blocked(request_id=token)])
        said = plant.step(
            at,
            [
                OperatorRequest(at=at, verb=Verb.STOP, scope="ra1"),
                Report(at=at, robot="ra1", epoch=1, accepted=stop.id),
            ],
        )
        assert {each.mode for each in said if isinstance(each, Stop)} == {StopMode.LATCH}  # else it is halted
    assert not plant.dispatcher.interference.noticed


def test_who_asked_hears_in_time_that_a_stop_has_left_and_is_not_kept(lane: StopLane) -> None:
    lane.step(10.0, [opened("sis_a"), Blocked(request_id="a")])
    due = lane.next_deadline
    assert due == 10.0 + ANSWERED_WITHIN_S
    (answer,) = lane.step(due, [])
    assert isinstance(answer, StopLeft)
    assert (answer.request, answer.scope, answer.refusal) == ("a", "sis_a", None)
    assert str(answer.why).startswith("the stop has left for sis_a, and the plant has not kept it")
    assert lane.next_deadline is None and lane.step(due + 10.0, []) == []


HOLD = OperatorAnswer(verb=Verb.HOLD, scope="sis_a", request="a", act=3, outcome=Outcome.DONE)


def test_who_asked_hears_in_time_that_an_act_has_happened_and_is_not_kept(lane: StopLane) -> None:
    lane.step(10.0, [Happened(at=10.0, answer=HOLD)])
    assert lane.next_deadline == 10.0 + ANSWERED_WITHIN_S
    (said,) = lane.step(10.0 + ANSWERED_WITHIN_S, [])
    assert isinstance(said, Unkept) and (said.request, said.act, said.outcome) == ("a", 3, Outcome.DONE)
    assert str(said.why).startswith("hold sis_a is done, and the plant has not kept it (its disk")
    lane.step(20.0, [Happened(at=20.0, answer=HOLD), Closed(request_id="a")])
    assert lane.next_deadline is None


def asked_to_hold(scope: str) -> Opened:
    return Opened(request=OperatorRequest(at=10.0, verb=Verb.HOLD, scope=scope, request="a"))


def test_who_asked_for_a_hold_hears_in_time_that_the_plant_has_yet_to_do_it(lane: StopLane) -> None:
    assert lane.step(10.0, [asked_to_hold("sis_a")]) == []
    (said,) = lane.step(10.0 + ANSWERED_WITHIN_S, [])
    assert isinstance(said, Unkept) and (said.request, said.outcome) == ("a", Outcome.SENT)
    assert str(said.why).startswith("hold sis_a has reached the plant, which has not done it yet (its disk")


def test_who_asked_for_a_hold_that_is_done_hears_that_it_is(lane: StopLane) -> None:
    lane.step(10.0, [asked_to_hold("sis_a"), Happened(at=10.5, answer=HOLD)])
    assert lane.step(10.0 + ANSWERED_WITHIN_S, []) == []
    (said,) = lane.step(10.5 + ANSWERED_WITHIN_S, [])
    assert str(said.why).startswith("hold sis_a is done, and the plant has not kept it")


def test_nobody_hears_that_a_hold_of_an_unknown_cell_waits(lane: StopLane) -> None:
    assert lane.step(10.0, [asked_to_hold("sis_z")]) == [] and lane.next_deadline is None


def test_an_act_with_commands_of_its_own_has_not_happened_before_these_leave() -> None:
    clear = Stop(id="7-1", robot="ra1", mode=StopMode.CLEAR)
    halt = Stop(id="7-1", robot="ra1", mode=StopMode.HALT)
    assert done_at_once([halt, HOLD]) == [HOLD] and done_at_once([HOLD, clear]) == [HOLD]
    assert done_at_once([clear, HOLD]) == []
    assert done_at_once([replace(HOLD, refusal=STILL_WAITS())]) == []


def test_a_stop_that_the_plant_has_sent_itself_is_told_to_have_left(lane: StopLane) -> None:
    lane.step(10.0, [opened("")])
    lane.step(10.1, [Departed(request_id="a")])
    (answer,) = lane.step(10.0 + ANSWERED_WITHIN_S, [])
    assert "left for the whole plant" in str(answer.why)


@pytest.mark.parametrize(
    ("scope", "events"),
    [("", []), ("sis_z", [Blocked(request_id="a")]), ("sis_z", [Departed(request_id="a")])],
)
def test_nobody_hears_that_a_stop_has_left_which_may_not_have(
    lane: StopLane, scope: str, events: list[Event]
) -> None:
    assert lane.step(10.0, [opened(scope), *events]) == []
    assert lane.next_deadline is None and lane.step(20.0, []) == []


def test_who_was_answered_hears_nothing_more(lane: StopLane) -> None:
    lane.step(10.0, [opened(""), Departed(request_id="a")])
    lane.step(10.1, [Closed(request_id="a"), Blocked(request_id="a"), Closed(request_id="of nobody")])
    assert lane.step(20.0, []) == []


def test_a_robot_that_was_sent_an_older_command_is_stopped_once_more(lane: StopLane) -> None:
    (stop,) = lane.step(10.0, [Overrun(robot="ra2")])
    assert stop.robot == "ra2"


def test_stops_depart_first_and_what_they_overtake_does_not() -> None:
    on, home = SetEffector(id="7-1", robot="ra1", on=True), Home(id="7-2", robot="ra2")
    halt = Stop(id="7-3", robot="ra1", mode=StopMode.HALT)
    latch = Stop(id="7-4", robot="ra1", mode=StopMode.LATCH)
    clear = Stop(id="7-5", robot="ra1", mode=StopMode.CLEAR)
    beat = Heartbeat(epoch=EPOCH)
    assert departure([on, home, halt, beat, latch, clear]) == ([halt, latch], [home, beat, clear], [on])
