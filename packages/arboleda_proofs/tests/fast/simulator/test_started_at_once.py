"""A plant whose device need not be heard first begins a waiting task in the step in which it starts."""

from __future__ import annotations

import pytest
import yaml

from arboleda.core.task_queue import TaskQueue
from arboleda.model.cell_states import CellState
from arboleda.model.messages import TaskState, Verb
from arboleda_drawn.plants import loaded
from arboleda_proofs.simulator.judged_world import BrokenInvariant, JudgedWorld

PLANT = """
name: shop
uses: [recipes.py]
kinds:
  one:
    facts: {level: [up, down]}
    verbs: {put: {effect: motion, with: {to: [up, down]}, sets: {level: $to}, takes_s: 1}}
cells: {cell: {devices: {mill: {kind: one, evidence: state}}, on_restart: go_on}}
"""
RECIPES = """
from arboleda.recipes import recipe, work


@recipe("lower")
def lower(cell):
    return work(cell.device("mill").put(to="down"), cell.wait(2))
"""


def with_one_that_waits(on_restart: str) -> JudgedWorld:
    """A plant in which one task waits, and the other was cut off by a start and went on since."""
    plant = yaml.safe_load(PLANT.replace("go_on", on_restart))
    watched = JudgedWorld(loaded(plant, {"recipes.py": RECIPES}).model)
    for id in ("first", "second"):
        watched.world.request_task(f"cell lower #{id}")
    watched.world.advance(1.0)
    watched.world.crash()
    watched.world.advance(5.0)
    watched.world.request_verb(Verb.RETRY, "cell")
    watched.world.advance(10.0)
    assert states(watched) == [TaskState.DONE, TaskState.QUEUED]
    return watched


def states(watched: JudgedWorld) -> list[TaskState]:
    return [each.state for each in watched.world.plant.intake.tasks.values()]


def test_a_cell_that_goes_on_by_itself_works_in_the_step_in_which_its_plant_starts() -> None:
    watched = with_one_that_waits("go_on")
    watched.world.crash()
    watched.world.advance(0.0)
    assert watched.world.plant.cells["cell"].state is CellState.EXECUTE
    watched.world.advance(10.0)
    assert states(watched) == [TaskState.DONE, TaskState.DONE]


def test_a_cell_that_waits_for_a_person_is_found_at_work_in_that_step(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    watched = with_one_that_waits("hold")
    monkeypatch.setattr(TaskQueue, "take_back", lambda self, waiting, *, cut_off: self.extend(waiting))
    watched.world.crash()
    with pytest.raises(BrokenInvariant, match="only_legal_cell_states: cell starts execute"):
        watched.world.advance(0.0)
