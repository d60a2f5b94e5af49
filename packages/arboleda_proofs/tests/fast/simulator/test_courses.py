"""Courses of tasks as their trees show them: what a step may say of its beginning."""

from __future__ import annotations

import math

import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.model.messages import Course
from arboleda.trees.leaves import Await
from arboleda_proofs.simulator.recorded.courses import TaskInProgress


class Leaving(Await):
    """Step that ends in the pass in which it began."""

    def __init__(self) -> None:
        Behaviour.__init__(self, "leave")


def task(*rests: tuple[float, Status, float], ended_at: float = 3.0) -> TaskInProgress:
    """A task of one step: when its tree came to rest, as what its step was, and since when by its word."""
    step = Leaving()
    seen = TaskInProgress("t", [step], 0.0, whole=True)
    for now, status, began in rests:
        step.status, step.began = status, began
        seen.look(now, now)
    seen.ended_at = ended_at
    return seen


RUNS = (1.0, Status.RUNNING, 1.0)
IS_DONE = (2.0, Status.SUCCESS, 1.0)
IS_RESET = (2.5, Status.INVALID, 1.0)


@pytest.mark.parametrize(
    "rests",
    [
        (RUNS,),
        (RUNS, IS_DONE),
        ((1.0, Status.SUCCESS, 1.0),),
        ((0.5, Status.RUNNING, 0.5), (1.0, Status.RUNNING, 1.0)),  # in another turn of what repeats it
        ((0.5, Status.FAILURE, 0.5), (1.0, Status.FAILURE, 1.0)),
        (RUNS, IS_DONE, IS_RESET),
    ],
)
def test_a_step_began_when_it_was_seen_to_begin(rests: tuple[tuple[float, Status, float], ...]) -> None:
    seen = task(*rests)
    assert not seen.differs(Course(seconds=3.0, begun={"leave #1": 1.0}))
    assert seen.differs(Course(seconds=3.0, begun={"leave #1": 2.0}))
    assert seen.differs(Course(seconds=3.0, begun={}))
    assert seen.differs(Course(seconds=2.0, begun={"leave #1": 1.0}))
    assert seen.differs(Course(seconds=3.0, begun={"leave #1": 1.0, "other #1": 1.0}))


@pytest.mark.parametrize(
    "rests",
    [
        ((1.0, Status.RUNNING, 0.5),),
        ((1.0, Status.RUNNING, -math.inf),),
        ((1.0, Status.SUCCESS, 0.5),),
        ((1.0, Status.RUNNING, 1.0), (2.0, Status.RUNNING, 1.5)),
        ((1.0, Status.RUNNING, 1.0), (2.0, Status.SUCCESS, 1.5)),
        ((1.0, Status.SUCCESS, 1.0), (2.0, Status.RUNNING, 1.0)),
        ((1.0, Status.INVALID, 0.5),),
    ],
)
def test_a_step_that_says_another_time_than_that_of_the_pass_is_found(
    rests: tuple[tuple[float, Status, float], ...],
) -> None:
    told = rests[-1][2]
    begun = {} if told == -math.inf else {"leave #1": told}
    assert task(*rests).differs(Course(seconds=3.0, begun=begun))


def test_a_step_that_begins_as_its_task_ends_is_not_told() -> None:
    seen = task(RUNS, IS_DONE)
    seen.nodes[0].began = 3.0  # type: ignore[attr-defined]
    assert not seen.differs(Course(seconds=3.0, begun={}))
    seen.nodes[0].began = 2.9  # type: ignore[attr-defined]
    assert seen.differs(Course(seconds=3.0, begun={"leave #1": 2.9}))


def test_nothing_is_learned_of_a_task_that_an_earlier_start_began() -> None:
    seen = TaskInProgress("t", [Leaving()], 0.0, whole=False)
    assert not seen.differs(None)
    assert seen.differs(Course(seconds=0.0, begun={}))


def test_a_step_is_known_by_the_name_that_it_has_at_the_end() -> None:
    """A step of a tree as XML has values of a script in its name once it knows them."""
    first, second = Leaving(), Leaving()
    seen = TaskInProgress("t", [first, second], 0.0, whole=True)
    second.status, second.began = Status.RUNNING, 1.0
    seen.look(1.0, 1.0)
    assert [*seen.steps] == ["leave #2"]
    second.name = "leave now"
    seen.ended_at = 2.0
    assert not seen.differs(Course(seconds=2.0, begun={"leave now #1": 1.0}))
