"""Every valid task, and what happens around one, over codec, bridge and virtual boards."""

from __future__ import annotations

import pytest

from arboleda.model.messages import TaskState
from arboleda.model.plant_model import Evidence
from arboleda.testing import Rig, shipped

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
