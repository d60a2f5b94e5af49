"""What people fill and empty is not what a task leaves behind."""

from __future__ import annotations

from pathlib import Path

from arboleda.plant_file.loader import load
from arboleda.simulator.invariants.part_places import PLACES
from arboleda.simulator.run import Simulation

from ..kinds.test_places import PLANT, written

FROM_A_DEVICE = PLANT.replace("inside: {of: oven}", "inside: {of: oven, supply: true}")


def test_a_task_may_empty_a_supply_of_a_device(tmp_path: Path) -> None:
    model = load(written(tmp_path, FROM_A_DEVICE, 'take("inside"), put("bin"), mover.home()'))
    result = Simulation(model, 1, lambda minute: [], invariants=PLACES).run(cycles=2)
    assert result.broken is None
    assert result.outcomes == {"done": result.cycles}


def test_it_may_not_empty_a_device_that_people_do_not_fill(tmp_path: Path) -> None:
    body = 'take("rack_1"), put("inside"), mover.home()'
    result = Simulation(load(written(tmp_path, PLANT, body)), 1, lambda minute: [], invariants=PLACES)
    broken = result.run(cycles=2).broken
    assert broken is not None
    assert broken.invariant == "done_tasks_leave_nothing_behind"
