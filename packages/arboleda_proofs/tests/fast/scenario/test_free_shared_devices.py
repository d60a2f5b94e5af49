"""A shared device that no cell holds and that only a person can help: who needs it is told, and goes on."""

from __future__ import annotations

import pytest
import yaml

from arboleda.model.messages import TaskState
from arboleda.rig.world import World
from arboleda_drawn.plants import loaded
from arboleda_proofs.simulator.judged_world import JudgedWorld

FILE = """
    name: bench
    uses: [recipes.py]
    kinds:
      oven: {verbs: {bake: {effect: process, takes_s: 8, on_stop: finish}}}
      vise:
        facts: {shut: bool}
        verbs: {clamp: {effect: switch, with: {'on': bool}, sets: {shut: $on}, holds: part}}
    shared:
      our_vise: {kind: vise}
      our_arm: {kind: arm, model: scara}
    cells:
      left:
        devices: {oven: {kind: oven}, vise: {shared: our_vise}, arm: {shared: our_arm}}
        targets: {home: {arm: {deg: [0, 0], mm: 0}}, nest: {arm: {deg: [60, 40], mm: 80}}}
        zone_wait_s: 3600
      right:
        devices: {oven: {kind: oven, name: oven_b}, vise: {shared: our_vise}, arm: {shared: our_arm}}
        targets: {home: {arm: {deg: [0, 0], mm: 0}}, nest: {arm: {deg: [-60, 40], mm: 80}}}
"""
RECIPES = """
from arboleda.recipes import recipe, work


@recipe("clamps")
def clamps(cell):
    oven, vise = cell.devices("oven", "vise")
    return work(oven.bake(), cell.using("vise", vise.clamp(on=True), vise.clamp(on=False)))


@recipe("goes")
def goes(cell):
    oven, arm = cell.devices("oven", "arm")
    return work(oven.bake(), cell.using("arm", arm.go("nest"), arm.home()))
"""


@pytest.fixture
def world() -> World:
    return JudgedWorld(loaded(yaml.safe_load(FILE), {"recipes.py": RECIPES}).model).world


def baking(world: World, text: str) -> None:
    """Let a task begin, which needs its shared device only later."""
    world.advance(15.0, lambda: world.plant.at_rest)
    world.request_task(text)
    assert world.advance(10.0, lambda: "oven" in world.obeyed)


def reason_of_failure(world: World) -> str:
    world.advance(20.0)
    (task,) = world.plant.intake.tasks.values()
    assert task.state is TaskState.FAILED and task.failure is not None
    return str(task.failure.sentence)


def test_a_part_in_it_is_told(world: World) -> None:
    baking(world, "left clamps")
    world.boards["our_vise"].body.facts["shut"] = True  # somebody shuts it by hand, with a part in it
    assert reason_of_failure(world) == (
        "left: our_vise, which no cell holds, may hold a part; release our_vise first, "
        "or take the part out by hand"
    )


def test_a_lost_reference_is_told(world: World) -> None:
    baking(world, "left goes")
    world.crash("our_arm")
    assert reason_of_failure(world).startswith("left cannot take our_arm: our_arm is not homed")
