"""Reports that are news are stepped at once, all others with the next step."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.core.plant import Plant
from arboleda.dispatch.ledger import Entry
from arboleda.kinds.joints import MoveJoints
from arboleda.model.messages import MotionState, Report, TaskRequest
from arboleda.model.plant_model import Evidence
from arboleda.runtime.parts.urgency import COMPANY_S, PASSING, RESTING_S, Urgency
from arboleda.testing.plants import shipped

REST = Report(
    at=0.0, robot="ra1", epoch=9, boot_id=4, state=MotionState.STOPPED, q=(0.0, 0.0, 0.0), piece=False
)
MOVES = replace(REST, state=MotionState.MOVING, accepted="7-1")
FURTHER = (0.1, 0.0, 0.0)


def plant_of(**declared) -> Plant:
    return Plant(shipped("sis_a", **declared), epoch=7, now=0.0)


@pytest.fixture
def plant():
    return plant_of()


def open_move(plant: Plant) -> None:
    move = MoveJoints(id="7-1", robot="ra1", q=FURTHER)
    plant.dispatcher.ledger.open(Entry(move, cell="sis_a", doing="moving", sent_at=0.0, deadline=9.0))


def patience(plant: Plant, *reports: Report) -> list[float]:
    urgency = Urgency(plant)
    return [urgency.within_s(report) for report in reports]


@pytest.mark.parametrize(
    "news",
    [
        {"state": MotionState.MOVING},
        {"accepted": "7-2"},
        {"done": "7-1"},
        {"rejected": "7-1", "refusal": "limite"},
        {"boot_id": 5},
        {"epoch": 10},
        {"plant": 7},
        {"homed": False},
        {"effector": True},
        {"piece": True},
    ],
    ids=lambda news: next(iter(news)),
)
def test_news_are_urgent(plant, news):
    assert patience(plant, REST, REST, replace(REST, **news)) == [0.0, RESTING_S, 0.0]


def test_a_repetition_or_a_position_alone_may_wait(plant):
    assert patience(plant, REST, REST.again(0.1), replace(REST, q=FURTHER)) == [0.0, RESTING_S, COMPANY_S]


def test_a_repetition_waits_less_while_a_task_waits_or_runs(plant):
    plant.step(1.0, [TaskRequest(at=1.0, text="sis_a 0B 7")])
    assert patience(plant, REST, REST) == [0.0, COMPANY_S]


@pytest.mark.parametrize("state", sorted(PASSING))
def test_a_cell_that_waits_for_its_robots_to_stand_hears_them_at_once(plant, state):
    plant.cells["sis_a"].state = state
    assert patience(plant, REST, REST) == [0.0, 0.0]


def test_each_robot_has_its_own_last_words(plant):
    other = replace(REST, robot="rm_sis_a", q=None, node=3)
    assert patience(plant, REST, other, REST, other) == [0.0, 0.0, RESTING_S, RESTING_S]


def test_a_robot_that_only_says_whether_it_moves_is_not_asked_to_wait():
    assert patience(plant_of(evidence=Evidence.STATE), REST, REST) == [0.0, 0.0]


def test_a_position_by_itself_waits_for_the_state_that_ends_the_move():
    plant = plant_of(evidence=Evidence.JOINTS)
    moves = Report(at=0.0, robot="ra1", state=MotionState.MOVING)
    stands = Report(at=0.0, robot="ra1", state=MotionState.STOPPED)
    place = Report(at=0.0, robot="ra1", q=FURTHER)
    open_move(plant)
    assert patience(plant, moves, place, stands, place) == [0.0, COMPANY_S, 0.0, 0.0]


def test_a_robot_that_moves_is_not_at_its_end_but_one_that_stands_may_be(plant):
    open_move(plant)
    assert patience(plant, MOVES, replace(MOVES, q=FURTHER), REST, REST) == [0.0, COMPANY_S, 0.0, 0.0]


def test_a_tree_that_awaits_the_piece_sensor_is_not_kept_waiting(plant):
    plant.cells["sis_a"].context.sensors.awaited = True
    silent = replace(REST, piece=None)
    assert patience(plant, REST, REST) == [0.0, 0.0]
    assert patience(plant, silent, silent) == [0.0, RESTING_S]


def test_a_stranger_is_not_asked_to_wait(plant):
    stranger = replace(REST, robot="nobody")
    assert patience(plant, stranger, stranger) == [0.0, 0.0]
