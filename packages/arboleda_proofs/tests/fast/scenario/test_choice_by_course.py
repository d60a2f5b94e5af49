"""A task for one of two cells goes by where their tasks are, also by steps that ended as they began."""

from __future__ import annotations

import pytest
import yaml

from arboleda.core.choosing import PastTimes
from arboleda_drawn.plants import loaded
from arboleda_proofs.simulator.judged_world import BrokenInvariant, JudgedWorld

FILE = """
    name: drawn_54509
    uses: [recipes.py]
    kinds: {oven: {verbs: {bake: {effect: process, takes_s: 8}}}}
    cells:
      left: {devices: {oven: {kind: oven}}}
      right: {devices: {oven: {kind: oven, name: oven_b}}}
"""
RECIPES = """
from arboleda.recipes import recipe, work


@recipe("bakes")
def bakes(cell):
    at_once = cell.timeout(cell.wait(1), 0)
    return work(cell.wait(5), cell.fallback(at_once, cell.device("oven").bake()))
"""


def cell_of_third() -> str:
    """The cell that does a task for any, after one on the left is done, while the right one is ahead."""
    world = JudgedWorld(loaded(yaml.safe_load(FILE), {"recipes.py": RECIPES}).model).world
    for text, seconds in (("left bakes", 20.0), ("right bakes", 2.0), ("left bakes", 7.05)):
        world.request_task(text)
        world.advance(seconds)
    world.request_task("left,right bakes #third")
    world.advance(0.01)
    return world.plant.intake.tasks["third"].order.cell


def test_it_goes_to_the_cell_whose_task_has_come_further() -> None:
    assert cell_of_third() == "right"


def test_the_simulator_notices_where_that_is_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(PastTimes, "remaining_s", lambda self, order, steps: 0.0)
    with pytest.raises(BrokenInvariant, match="tasks_go_to_the_best_cell"):
        cell_of_third()
