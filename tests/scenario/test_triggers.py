"""A machine's start signal begins an arm's own palletizing cycle; none is lost in silence."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.model.messages import TaskRequest, TaskState
from arboleda.model.plant_model import PlantModel
from arboleda.testing import Rig, shipped

from ..cells import with_robot


def refusing() -> PlantModel:
    """The shipped plant, whose arms refuse a trigger during their own cycle."""
    cells = (with_robot(cell, "arm", queue_triggers=False) for cell in shipped().cells)
    return replace(shipped(), cells=tuple(cells))


def trigger(rig: Rig, arm: str) -> TaskState:
    before = len(rig.changes)
    rig.tell(TaskRequest(at=rig.now, text=f"{arm} palletizing", trigger=True))
    return rig.changes[before].state


def all_done(rig: Rig) -> bool:
    return rig.plant.at_rest and not any(cell.queue for cell in rig.plant.cells.values())


@pytest.fixture
def rig() -> Rig:
    rig = Rig(shipped())
    rig.wait(0.5)
    return rig


def test_the_second_arms_cycle_starts_while_the_first_ones_runs(rig: Rig) -> None:
    trigger(rig, "ra1")
    rig.wait(1.0)
    trigger(rig, "ra2")
    rig.wait(0.1)
    running = [cell.cell.name for cell in rig.plant.cells.values() if cell.task is not None]
    assert running == ["sis_a", "sis_b"]
    assert rig.wait(60, until=lambda: all_done(rig))
    assert [change.state for change in rig.outcomes().values()] == [TaskState.DONE, TaskState.DONE]


def test_a_trigger_during_the_arms_own_cycle_waits_for_its_end(rig: Rig) -> None:
    for _ in range(3):
        assert trigger(rig, "ra1") is TaskState.QUEUED
        rig.wait(0.5)
    assert rig.wait(90, until=lambda: all_done(rig))
    assert [change.state for change in rig.outcomes().values()] == [TaskState.DONE] * 3


def test_where_the_plant_file_says_so_it_is_refused_with_a_sentence() -> None:
    rig = Rig(refusing())
    rig.wait(0.5)
    assert trigger(rig, "ra1") is TaskState.QUEUED
    assert trigger(rig, "ra1") is TaskState.REFUSED
    assert "in its own cycle" in str(rig.changes[-1].sentence)
    assert rig.submit("ra1 palletizing").state is TaskState.QUEUED  # a person's task is no trigger
    assert rig.wait(90, until=lambda: all_done(rig))
    assert trigger(rig, "ra1") is TaskState.QUEUED


def test_a_storage_task_is_not_the_arms_own_cycle() -> None:
    rig = Rig(refusing())
    rig.wait(0.5)
    rig.submit("sis_a 0B 7")
    assert trigger(rig, "ra1") is TaskState.QUEUED
