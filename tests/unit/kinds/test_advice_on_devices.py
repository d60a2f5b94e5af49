"""What is advised where a part is in a device that no robot carries: a recovery cannot bring that back."""

from __future__ import annotations

from arboleda.core import reasons
from arboleda.model.advice import sentence
from arboleda.model.messages import TaskState, Verb

from .lab import Bench, model


def test_after_a_failure_the_device_is_to_be_released() -> None:
    here = Bench(model())
    here.submit("bench careless")
    assert here.outcome().state is TaskState.FAILED
    assert here.wait(30.0, lambda: bool(here.plant.advice("bench")))
    ways = here.plant.advice("bench")
    assert str(sentence(ways)) == "release oven, then resume bench"
    assert "oven may hold a part: clamped is true" in str(reasons.of_hold(here.plant.cells["bench"]))
    for each in ways:  # none is refused once those before it are done
        assert here.operate(Verb(each.do), each.scope) is None
        here.wait(3.0)
    assert here.plant.advice("bench") == ()


def test_after_a_stop_the_device_is_to_be_released_once_the_cell_is_reset() -> None:
    here = Bench(model())
    here.submit("bench bake 10")
    assert here.wait(30.0, lambda: here.told[-1:] == ["oven close"])
    assert here.operate(Verb.STOP) is None
    here.wait(3.0)
    told = str(sentence(here.plant.advice("bench")))
    assert told == "clear bench, then reset bench, then release oven, then resume bench"
