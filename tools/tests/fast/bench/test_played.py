"""The robots of the benchmarks convince a plant: what they report ends its tasks."""

from __future__ import annotations

import pytest

from arboleda.core.plant import Plant
from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.messages import Heartbeat, TaskChanged, TaskRequest
from arboleda.testing.plants import shipped
from arboleda_bench import clockwork, played

MOVE_S = 0.3


@pytest.fixture
def clock(monkeypatch):
    """The time that the crew reads, moved by hand."""
    now = [100.0]
    monkeypatch.setattr(clockwork.time, "monotonic", lambda: now[0])
    return now


@pytest.fixture
def house(clock):
    """A plant of one cell, its crew, and what the plant has said."""
    plant, inbox, said = Plant(shipped("sis_a"), epoch=7, now=clock[0]), [], []
    crew = played.Crew(plant.model, inbox.append, move_s=MOVE_S)

    def go_on(seconds: float) -> None:
        until = clock[0] + seconds
        while clock[0] < until:
            clock[0] += 0.01
            while crew.clockwork.do_one():
                pass
            events, inbox[:] = list(inbox), []
            for message in plant.step(clock[0], events):
                said.append(message)
                crew.send(message)

    crew.appear()
    go_on(0.5)
    return plant, inbox, said, crew, go_on


def test_a_task_is_done(house, clock):
    _, inbox, said, _, go_on = house
    inbox.append(TaskRequest(at=clock[0], text="sis_a 0B 7"))
    go_on(5.0)
    assert [each.state.value for each in said if isinstance(each, TaskChanged)] == [
        "queued",
        "running",
        "done",
    ]
    kinds = [type(each) for each in said if isinstance(each, FollowPath | MoveJoints | SetEffector)]
    assert kinds == [FollowPath, MoveJoints, SetEffector, MoveJoints, SetEffector, MoveJoints]


def test_a_reaction_is_a_command_that_no_dwell_precedes(house, clock):
    _, inbox, _, crew, go_on = house
    inbox.append(TaskRequest(at=clock[0], text="sis_a 0B 7"))
    go_on(5.0)
    assert len(crew.reactions) == 3  # path to pick-up, pick-up to effector, station to effector


def test_every_robot_reports_ten_times_a_second(house):
    _, _, _, crew, go_on = house
    before = crew.repeats
    go_on(1.0)
    assert crew.repeats - before == pytest.approx(20, abs=1)


def test_robots_hear_which_plant_they_belong_to(house):
    plant, _, said, _, _ = house
    assert Heartbeat(epoch=7) in said
    assert plant.dispatcher.beliefs["ra1"].answered
