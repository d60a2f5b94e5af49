"""Every valid task, and what happens around one; a robot with `link: none` is part of the picture alone."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.model.commands import Command
from arboleda.model.messages import MotionState, Report, TaskState, Verb
from arboleda.model.plant_model import Evidence, Link
from arboleda.testing import Rig, shipped

from ..cells import with_robot
from ..lengths import sample


@pytest.mark.sampled(3)
@pytest.mark.parametrize("cell", ["sis_a", "sis_b", "sis_c"])
def test_each_task_of_a_cell_is_done(cell: str) -> None:
    rig = Rig(shipped())
    where = rig.model.cell(cell)
    texts = [f"{cell} {path} {station}" for path in where.paths for station in sample(range(9), every=4)]
    for text in texts:
        assert rig.submit(text).state in (TaskState.QUEUED, TaskState.RUNNING)
    rig.wait(81 * 60, until=lambda: rig.plant.at_rest and not rig.plant.cells[cell].queue)
    assert [(change.text, change.state) for change in rig.outcomes().values()] == [
        (text, TaskState.DONE) for text in texts
    ]


@pytest.mark.parametrize("evidence", list(Evidence))
def test_three_cells_work_at_the_same_time_at_every_level(evidence: Evidence) -> None:
    rig = Rig(shipped(evidence=evidence))
    for text in ("sis_a 0B 7", "sis_b 0C 3", "sis_c 0A 0", "ra1 palletizing"):
        rig.submit(text)
    rig.wait(2.0)
    assert all(cell.task is not None for cell in rig.plant.cells.values())
    rig.wait(60, until=lambda: rig.plant.at_rest and not rig.plant.cells["sis_a"].queue)
    assert {change.state for change in rig.outcomes().values()} == {TaskState.DONE}


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
