"""A plant is at rest only after the time for which its file allows a robot to wait for a zone."""

from __future__ import annotations

import pytest
import yaml

from arboleda.model.messages import TaskState
from arboleda_drawn.plants import loaded
from arboleda_proofs.simulator.judged_world import JudgedWorld

FILE = """
    name: drawn_52445
    uses: [recipes.py]
    kinds:
      one:
        facts: {door: [up, down]}
        verbs: {put: {effect: switch, with: {to: [up, down]}, sets: {door: $to}}}
    cells:
      cell:
        devices: {arm: {kind: arm, model: scara}, oven: {kind: one}}
        targets:
          home: {arm: {deg: [0, 0], mm: 0}}
          mouth: {arm: {deg: [50.78, -28.45], mm: 40}}
        zone_wait_s: 700
    zones: {inside: {poses: [cell mouth], free_while: {oven: {door: up}}}}
"""
RECIPES = """
from arboleda.recipes import recipe, work


@recipe("shuts")
def shuts(cell):
    arm, oven = cell.devices("arm", "oven")
    return work(cell.fallback(arm.visit("mouth", oven.put(to="down")), cell.wait(1)), arm.home())
"""


@pytest.mark.long
def test_a_task_that_waits_as_long_as_it_may_comes_to_its_end() -> None:
    watched = JudgedWorld(loaded(yaml.safe_load(FILE), {"recipes.py": RECIPES}).model)
    watched.world.advance(5.0)
    watched.world.request_task("cell shuts #one")
    watched.world.advance(10.0)
    assert watched.world.plant.zones.queue.waiting, "the oven waits until the arm is out of its way"
    watched.come_to_rest()
    assert watched.world.plant.intake.tasks["one"].state is TaskState.DONE
    assert 700.0 < watched.seconds < 800.0
