"""A machine's start signal while the arm is in its own cycle, by what the plant file says of that arm."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from arboleda.model.messages import TaskState
from arboleda.model.plant_model import Evidence

from .conftest import Hand

CYCLE = "ra1 palletizing"


@pytest.mark.parametrize(
    ("trigger", "queues", "state"),
    [(True, False, TaskState.REFUSED), (True, True, TaskState.QUEUED), (False, False, TaskState.QUEUED)],
    ids=["refused", "queued by the plant file", "of a person"],
)
def test_a_second_request_for_the_cycle(
    hand: Callable[..., Hand], trigger: bool, queues: bool, state: TaskState
) -> None:
    plant = hand(Evidence.IDS, queue_triggers=queues)
    plant.awake()
    plant.submit(CYCLE)
    told = plant.submit(CYCLE, trigger=trigger, request="second")
    (answer,) = [each for each in told if getattr(each, "request", None) == "second"]
    assert answer.state is state and answer.for_now is (state is TaskState.REFUSED)
