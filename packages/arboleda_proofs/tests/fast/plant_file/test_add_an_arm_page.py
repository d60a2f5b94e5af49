"""The arm of the page on adding one does its task under the `sim`."""

from __future__ import annotations

from pathlib import Path

from tests.unit.plant_file.test_add_an_arm_page import folder as folder

from arboleda_proofs.testing import Sim


def test_the_task_of_the_page_is_done(folder: Path, sim: Sim) -> None:
    sim.plant(folder / "my_plant.yaml")
    task = sim.submit("bay 0B 0")
    sim.run(until=lambda: task.ended)
    assert task.state == "done"
