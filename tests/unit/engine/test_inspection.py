"""What the inspection reads of a plant and of its cells is what they have now."""

from __future__ import annotations

from operator import attrgetter

import pytest

from arboleda.engine import inspection
from arboleda.testing import Rig, shipped

READ = [name for name in inspection.__all__ if isinstance(getattr(inspection, name), attrgetter)]


@pytest.mark.parametrize("name", READ)
def test_each_is_there_of_every_plant(name: str) -> None:
    plant = Rig(shipped("sis_a")).plant
    of_cell = "CellRun" in inspection.__annotations__[name]
    getattr(inspection, name)(plant.cells["sis_a"] if of_cell else plant)


def test_it_reads_what_is_so_now() -> None:
    rig = Rig(shipped("sis_a"))
    plant, run = rig.plant, rig.plant.cells["sis_a"]
    assert set(inspection.beliefs_of(plant)) == set(plant.model.robots)
    assert not inspection.tasks_of(plant) and not inspection.is_ending(plant)
    rig.submit("sis_a 0B 7 #lot")
    rig.wait(3.0)
    assert "lot" in inspection.tasks_of(plant)
    assert inspection.ledger_of(plant).entries and inspection.time_of(run).now > 0.0
    assert inspection.teaching_of(run) is None and inspection.walk_of(run) is None
