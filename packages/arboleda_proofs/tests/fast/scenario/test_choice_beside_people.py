"""A task for one of two cells with people goes to the one that works, and nobody takes these for offline."""

from __future__ import annotations

import yaml

from arboleda.model.messages import Verb
from arboleda_drawn.plants import loaded
from arboleda_proofs.simulator.judged_world import JudgedWorld

FILE = """
    name: drawn_1103
    uses: [recipes.py]
    kinds: {oven: {verbs: {bake: {effect: process, takes_s: 8}}}}
    cells:
      left: {devices: {oven: {kind: oven}, ana: {kind: person}}}
      right: {devices: {oven: {kind: oven, name: oven_b}, ana: {kind: person, name: ana_b}}}
"""
RECIPES = """
from arboleda.recipes import recipe


@recipe("bakes")
def bakes(cell):
    return cell.device("oven").bake()
"""


def test_the_cell_that_works_is_chosen_before_one_whose_queue_stands() -> None:
    world = JudgedWorld(loaded(yaml.safe_load(FILE), {"recipes.py": RECIPES}).model).world
    world.request_verb(Verb.STOP, "left")
    world.request_task("right bakes #first")
    world.advance(2.05)
    world.request_task("left,right bakes #second")
    world.advance(0.01)
    assert world.plant.intake.tasks["second"].order.cell == "right"
