"""Verdict of the simulator on a task after a hold, and after a device that lied."""

from __future__ import annotations

import pytest
import yaml

from arboleda.model.messages import TaskState, Verb
from arboleda_drawn.plants import loaded
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.judged_world import JudgedWorld

FILE = """
    name: drawn_602
    uses: [recipes.py]
    kinds: {press: {verbs: {strike: {effect: process, takes_s: 1, on_stop: finish}}}}
    cells:
      cell:
        devices:
          arm: {kind: arm, model: scara}
          jaw: {kind: effector, tool_of: arm}
          press: {kind: press}
        targets:
          home: {arm: {deg: [0, 0], mm: 0}}
          tray: {arm: {deg: [34.57, -38.59], mm: 80, approach_mm: 30}}
        places: {tray: {supply: true}}
"""
RECIPES = """
from arboleda.recipes import recipe, work


@recipe("takes")
def takes(cell):
    arm, jaw = cell.devices("arm", "jaw")
    return work(arm.visit("tray", jaw.grip()), arm.visit("tray", jaw.let_go()))


@recipe("strikes")
def strikes(cell):
    return cell.repeat(cell.device("press").strike(), times=3)
"""


@pytest.fixture
def watched() -> JudgedWorld:
    """The plant, which has been on for some seconds."""
    watched = JudgedWorld(loaded(yaml.safe_load(FILE), {"recipes.py": RECIPES}).model)
    watched.world.advance(5.0)
    return watched


def state_of(watched: JudgedWorld, task: str) -> TaskState:
    return watched.world.plant.intake.tasks[task].state


def test_what_is_kept_as_a_held_step_goes_on_is_of_the_turn_before_the_next_command(
    watched: JudgedWorld,
) -> None:
    watched.world.request_task("cell strikes #one")
    watched.world.advance(0.5)
    watched.world.request_verb(Verb.HOLD, "cell")
    watched.world.advance(3.0)
    watched.world.request_verb(Verb.RETRY, "cell")
    watched.world.advance(10.0)
    assert state_of(watched, "one") is TaskState.DONE


def test_a_task_has_not_left_the_part_that_a_hand_took_before_it_while_it_said_that_it_was_open(
    watched: JudgedWorld,
) -> None:
    watched.expect(Fault(kind="stale_fact", at=5.1, seconds=30.0, target="jaw", word="on", seed=1))
    watched.world.request_task("cell takes #one")
    watched.world.request_task("cell strikes #two")
    watched.world.advance(60.0)
    assert (state_of(watched, "one"), state_of(watched, "two")) == (TaskState.FAILED, TaskState.DONE)
