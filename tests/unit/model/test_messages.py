"""Which of what is kept has to be durable before a command leaves; the states of a task."""

from __future__ import annotations

import pytest

from arboleda.model.errors import IllegalTransition
from arboleda.model.messages import Fact, Journal, Remember, TaskChanged, TaskState, Verb, outlives_power
from arboleda.model.sentence import OWN
from arboleda.model.task import Order, Task


@pytest.mark.parametrize(
    ("fact", "value", "outlives"),
    [
        (Fact.LATCH, "on", True),
        (Fact.LATCH, None, True),
        (Fact.EFFECTOR, "switching", True),
        (Fact.EFFECTOR, "on", True),
        (Fact.EFFECTOR, "off", False),
        (Fact.QUARANTINE, "ra1", True),
        (Fact.QUARANTINE, None, False),
        (Fact.EMPTIED, "true", True),
        (Fact.EMPTIED, None, True),
        (Fact.DISPLACED, "true", True),
        (Fact.DISPLACED, None, False),
        (Fact.STORED, "0 7", True),
        (Fact.STEP, "[]", False),
    ],
)
def test_what_makes_the_plant_careful_outlives_a_power_cut(
    fact: Fact, value: str | None, outlives: bool
) -> None:
    assert outlives_power(Remember(fact=fact, name="ra1", value=value)) is outlives


@pytest.mark.parametrize("state", [TaskState.QUEUED, TaskState.RUNNING, TaskState.DONE])
def test_so_does_every_change_of_a_task(state: TaskState) -> None:
    assert outlives_power(TaskChanged(task="a", text="sis_a 0B 1", cell="sis_a", state=state))


def test_so_does_every_act_of_an_operator() -> None:
    assert outlives_power(Journal(verb=Verb.STOP, scope="", cell=None, sentence=OWN(text="stopped")))


ENDS = (TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED)


@pytest.mark.parametrize("state", TaskState, ids=lambda state: state.value)
@pytest.mark.parametrize("end", ENDS, ids=lambda end: end.value)
def test_a_task_that_has_ended_stays_as_it_is(end: TaskState, state: TaskState) -> None:
    task = Task("t-1", Order(text="sis_a 0B 7", cell="sis_a", recipe="storage"))
    task.become(TaskState.RUNNING, 1.0)
    task.become(end, 2.0)
    with pytest.raises(IllegalTransition, match=f"task t-1 cannot go from {end.value} to {state.value}"):
        task.become(state, 3.0)
    assert (task.state, task.ended_at) == (end, 2.0)
