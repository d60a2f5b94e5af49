"""A shared device that boots is nothing to a task of a cell that does not hold it."""

from __future__ import annotations

import yaml

from arboleda.model.messages import TaskState, Verb
from arboleda.rig.world import PLANT
from arboleda_drawn.plants import loaded
from arboleda_proofs.simulator.judged_world import JudgedWorld

FILE = """
    name: drawn_1090
    uses: [recipes.py]
    kinds:
      oven: {verbs: {bake: {effect: process, takes_s: 8, on_stop: finish}}}
      lamp: {facts: {lit: bool}, verbs: {light: {effect: switch, with: {'on': bool}, sets: {lit: $on}}}}
    shared: {our_lamp: {kind: lamp}}
    cells:
      left: {devices: {oven: {kind: oven}, lamp: {shared: our_lamp}}}
      right: {devices: {oven: {kind: oven, name: oven_b}, lamp: {shared: our_lamp}}}
"""
RECIPES = """
from arboleda.recipes import recipe, work


@recipe("bakes")
def bakes(cell):
    oven, lamp = cell.devices("oven", "lamp")
    lit = cell.using("lamp", lamp.light(on=True))
    return work(lit, oven.bake(), cell.using("lamp", lamp.light(on=False)))
"""


def test_a_task_goes_on_though_a_device_of_nobody_has_booted() -> None:
    world = JudgedWorld(loaded(yaml.safe_load(FILE), {"recipes.py": RECIPES}).model).world
    world.request_task("left bakes")
    assert world.advance(10.0, lambda: "oven" in world.obeyed)
    world.advance(1.0)
    world.crash("our_lamp")
    world.crash(PLANT)
    world.advance(10.0)
    world.request_verb(Verb.RESUME, "left")
    world.advance(5.0)
    (task,) = world.plant.intake.tasks.values()
    assert task.state is TaskState.DONE
