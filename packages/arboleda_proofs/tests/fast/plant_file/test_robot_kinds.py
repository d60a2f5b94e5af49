"""A robot of a kind of one's own goes to its targets under the `sim`."""

from __future__ import annotations

from pathlib import Path

from tests.unit.plant_file.test_robot_kinds import write

from arboleda_proofs.testing import Sim


def test_a_robot_of_a_kind_of_ones_own_goes_to_targets(tmp_path: Path, sim: Sim) -> None:
    plant = sim.plant(write(tmp_path))
    assert plant.robots["cart"].kind_name == "cart"
    task = sim.submit("bay dock")
    sim.run(until=lambda: task.ended)
    assert task.history == ["queued", "running", "done"]
