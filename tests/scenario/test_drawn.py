"""A robot with `link: none`: part of the picture, and of nothing else."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.model.commands import Command
from arboleda.model.messages import MotionState, Report, TaskState, Verb
from arboleda.model.plant_model import Evidence, Link
from arboleda.testing import Rig, shipped

from ..cells import with_robot


@pytest.fixture(params=list(Evidence), ids=lambda evidence: evidence.value)
def rig(request: pytest.FixtureRequest) -> Rig:
    """One cell whose mobile robot is only drawn, whatever evidence it declares."""
    model = shipped("sis_a")
    cell = model.cell("sis_a")
    drawn = with_robot(cell, "mobile", link=Link.NONE, evidence=request.param)
    rig = Rig(replace(model, cells=(drawn,)))
    rig.wait(0.5)
    return rig


def test_its_cell_is_operated_and_palletizes_without_it(rig: Rig) -> None:
    for verb in (Verb.STOP, Verb.CLEAR, Verb.RESET, Verb.RESUME):
        assert rig.operate(verb) is None
        rig.wait(2.0)
    task = rig.submit("sis_a palletizing")
    assert rig.wait(60.0, until=lambda: rig.outcomes()[task.task].state is TaskState.DONE)


def test_nothing_is_asked_of_it(rig: Rig) -> None:
    for verb in (Verb.STOP, Verb.CLEAR, Verb.RESET):
        assert rig.operate(verb) is None
        rig.wait(2.0)
    assert {message.robot for message in rig.sent if isinstance(message, Command)} == {"ra1"}


def test_a_task_that_needs_it_is_refused(rig: Rig) -> None:
    assert rig.submit("sis_a 0B 7").state is TaskState.REFUSED


def test_what_somebody_says_in_its_name_does_not_bring_it_online(rig: Rig) -> None:
    rig.tell(Report(at=rig.now, robot="rm_sis_a", node=0, state=MotionState.STOPPED))
    mobile = rig.snapshot()["robots"][1]
    assert (mobile["online"], str(mobile["obstacle"])) == (False, "rm_sis_a is only drawn (link: none)")
