"""A cycle is a task that told a device to do something before it ended."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from arboleda.plant_file.loader import load
from arboleda_proofs.simulator.run import Result, Simulation
from arboleda_proofs.simulator.scripted_people import Script, script_from

PLANT = """
name: one
uses: [recipes.py]
kinds: {lamp: {facts: {lit: bool}, verbs: {light: {effect: switch, sets: {lit: true}}}}}
cells: {bench: {devices: {lamp: {kind: lamp}}}}
"""
SHINE = """
@recipe("shine")
def shine(cell):
    return cell.device("lamp").light()
"""
IDLE = """
from arboleda.recipes import recipe

@recipe("idle")
def idle(cell):
    return cell.wait(1)
"""


def plant(folder: Path, recipes: str) -> Any:
    (folder / "recipes.py").write_text(recipes, "utf-8")
    (folder / "plant.yaml").write_text(PLANT, "utf-8")
    return load(folder / "plant.yaml")


def run(model: Any, script: Script | None = None) -> Result:
    return Simulation(model, 1, lambda minute: (), script=script).run(seconds=20)


def test_a_task_that_does_nothing_is_an_outcome_and_no_cycle(tmp_path: Path) -> None:
    model = plant(tmp_path, IDLE + SHINE)
    tasks = [{"at": 2.0, "task": "bench idle"}, {"at": 5.0, "task": "bench shine"}]
    found = run(model, script_from(model, {"people": tasks, "seconds": 20}))
    assert (found.cycles, found.outcomes) == (1, {"done": 2})


def test_customers_whose_tasks_do_nothing_make_no_cycle(tmp_path: Path) -> None:
    found = run(plant(tmp_path, IDLE))
    assert found.cycles == 0 and found.outcomes["done"] > 1
