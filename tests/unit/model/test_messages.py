"""Which of what is kept has to be durable before a command leaves."""

from __future__ import annotations

import pytest

from arboleda.model.messages import Fact, Journal, Remember, TaskChanged, TaskState, Verb, outlives_power
from arboleda.model.sentence import OWN


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
