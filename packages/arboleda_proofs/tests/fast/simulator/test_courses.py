"""Courses of tasks as their trees show them: when a repeated step began last."""

from __future__ import annotations

import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.model.messages import Course
from arboleda.recipes.decorators import Times
from arboleda.trees.leaves import Await
from arboleda_proofs.simulator.recorded.courses import TaskInProgress


class Turns(Times):
    """Repeating step of which only the turn counts."""

    def __init__(self, child: Behaviour) -> None:
        Behaviour.__init__(self, "turns")
        self.done = 0
        child.parent = self


class Leaving(Await):
    """Step that ends in the pass in which it began."""

    def __init__(self) -> None:
        Behaviour.__init__(self, "leave")


@pytest.fixture
def seen() -> TaskInProgress:
    """A task of 3 s whose step was seen at 1 s, was reset, and began anew as the task ended."""
    step = Leaving()
    turns = Turns(step)
    task = TaskInProgress("t", [turns, step], 0.0, whole=True)
    for status, now in ((Status.SUCCESS, 1.0), (Status.INVALID, 2.0)):
        step.status = status
        task.look(now, now)
    turns.done, step.status, step.began, task.ended_at = 1, Status.SUCCESS, 3.0, 3.0
    return task


@pytest.mark.parametrize(
    ("begun", "differs"),
    [
        ({}, False),  # its last turn took no time before the end, and is not told
        ({"leave #1": 3.0}, False),
        ({"leave #1": 2.0}, False),  # nobody looked between two rests
        ({"leave #1": 0.5}, True),
        ({"leave #1": 2.5}, True),
        ({"other #1": 1.0}, True),
    ],
)
def test_a_step_that_was_reset_may_have_begun_anew_at_a_rest(
    seen: TaskInProgress, begun: dict[str, float], differs: bool
) -> None:
    assert seen.differs(Course(seconds=3.0, begun=begun)) is differs


def test_a_step_that_began_twice_in_one_turn_and_was_reset_each_time_may_have_begun_at_a_rest() -> None:
    step = Leaving()
    turns = Turns(step)
    turns.done = 1
    task = TaskInProgress("t", [turns, step], 0.0, whole=True)
    for now, status in enumerate((Status.SUCCESS, Status.INVALID, Status.SUCCESS, Status.INVALID), 1):
        step.status = status
        task.look(float(now), float(now))
    task.look(5.0, 5.0)  # it began, ended and was reset between two looks
    task.ended_at = 6.0
    assert not task.differs(Course(seconds=6.0, begun={"leave #1": 5.0}))
    assert task.differs(Course(seconds=6.0, begun={"leave #1": 5.5}))


def test_a_step_that_failed_at_once_may_have_been_tried_again_as_the_task_ended() -> None:
    step = Leaving()
    turns = Turns(step)
    task = TaskInProgress("t", [turns, step], 0.0, whole=True)
    step.status, turns.done = Status.FAILURE, 1  # what tries again has counted this one
    task.look(1.0, 1.0)
    task.ended_at = 2.0
    assert not task.differs(Course(seconds=2.0, begun={"leave #1": 2.0}))
    assert task.differs(Course(seconds=2.0, begun={"leave #1": 1.5}))


def test_a_step_that_was_at_work_was_not_tried_again_where_its_turn_is_the_same() -> None:
    step = Leaving()
    task = TaskInProgress("t", [Turns(step), step], 0.0, whole=True)
    for now, status in ((1.0, Status.RUNNING), (1.5, Status.SUCCESS)):
        step.status = status
        task.look(now, now)
    task.ended_at = 2.0
    assert not task.differs(Course(seconds=2.0, begun={"leave #1": 1.0}))
    assert task.differs(Course(seconds=2.0, begun={"leave #1": 2.0}))


def test_a_step_is_known_by_the_name_that_it_has_at_the_end() -> None:
    """A step of a tree as XML has values of a script in its name once it knows them."""
    first, second = Leaving(), Leaving()
    first.began = second.began = 0.0
    task = TaskInProgress("t", [first, second], 0.0, whole=True)
    assert "leave #2" in task.steps
    second.name = "leave now"
    second.status = Status.RUNNING
    task.look(1.0, 1.0)
    task.ended_at = 2.0
    assert not task.differs(Course(seconds=2.0, begun={"leave now #1": 1.0}))
