"""A shared device that no cell holds and in which a part is: who needs it is told, and waits for nobody."""

from __future__ import annotations

import yaml

from arboleda.campaigns.random_plants import loaded
from arboleda.model.messages import TaskState
from arboleda.simulator.judged_world import JudgedWorld

FILE = """
    name: bench
    uses: [recipes.py]
    kinds:
      oven: {verbs: {bake: {effect: process, takes_s: 8, on_stop: finish}}}
      vise:
        facts: {shut: bool}
        verbs: {clamp: {effect: switch, with: {'on': bool}, sets: {shut: $on}, holds: part}}
    shared: {our_vise: {kind: vise}}
    cells:
      left: {devices: {oven: {kind: oven}, vise: {shared: our_vise}}, zone_wait_s: 3600}
      right: {devices: {oven: {kind: oven, name: oven_b}, vise: {shared: our_vise}}}
"""
RECIPES = """
from arboleda.recipes import recipe, work


@recipe("works")
def works(cell):
    oven, vise = cell.devices("oven", "vise")
    return work(oven.bake(), cell.using("vise", vise.clamp(on=True), vise.clamp(on=False)))
"""


def test_a_task_that_needs_it_fails_and_names_the_way_out() -> None:
    watched = JudgedWorld(loaded(yaml.safe_load(FILE), {"recipes.py": RECIPES}).model)
    world = watched.world
    world.request_task("left works")
    assert world.advance(10.0, lambda: "oven" in world.obeyed)
    world.boards["our_vise"].body.facts["shut"] = True  # somebody shuts it by hand, with a part in it
    world.advance(15.0)
    (task,) = world.plant.intake.tasks.values()
    assert task.state is TaskState.FAILED
    assert str(task.failure.sentence) == (
        "left: our_vise, which no cell holds, may hold a part; release our_vise first, "
        "or take the part out by hand"
    )
