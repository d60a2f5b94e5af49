"""What is advised where a zone is kept, and a mobile robot whose way comes by a target in one."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import pytest

from arboleda.core.plant import Plant
from arboleda.model.messages import MotionState, OperatorRequest, Report, Verb
from arboleda.testing import Rig

from ..following import advised, follow, works
from ..plants import plant_text, read

LEFT = "left: {kind: arm, model: scara, %s}"
RIGHT = "right: {kind: arm, model: scara, base: {origin_m: [0.6, 0]}, %s}"
ONE_CELL = f"""
name: one
uses: [recipes.py]
cells:
  aa:
    devices:
      {LEFT}
      {RIGHT}
    targets:
      home: {{left: {{deg: [0, 0], mm: 0}}, right: {{deg: [0, 0], mm: 0}}}}
      nest: {{left: {{deg: [60, 10], mm: 50}}, right: {{deg: [-60, 10], mm: 50}}}}
zones:
  z: {{poses: [aa nest]}}
"""
TWO_CELLS = f"""
name: two
uses: [recipes.py]
cells:
  aa:
    devices:
      {LEFT}
    targets: {{home: {{left: {{deg: [0, 0], mm: 0}}}}, nest: {{left: {{deg: [60, 10], mm: 50}}}}}}
  bb:
    devices:
      {RIGHT}
    targets: {{home: {{right: {{deg: [0, 0], mm: 0}}}}, nest: {{right: {{deg: [-60, 10], mm: 50}}}}}}
zones:
  z: {{poses: [aa nest, bb nest]}}
"""
RECIPES = """
from arboleda.recipes import recipe, work

@recipe("go")
def go(cell):
    left = cell.device("left")
    return work(left.visit("nest", cell.wait(3.0)), left.home())

@recipe("other")
def other(cell):
    return cell.device("right").home()
"""
HOMINGS = {
    "by a routine": "evidence: ids",
    "assumed": "evidence: joints, assume_homed: true",
    "assumed, with numbers": "evidence: ids, assume_homed: true",
    "by a person": "evidence: joints",
}
PLANTS = {
    "in one cell": (ONE_CELL, ["aa"]),
    "in two cells": (TWO_CELLS, ["aa", "bb"]),
    "in two cells, the other one first": (TWO_CELLS, ["bb", "aa"]),
}


def stopped_in_the_zone(folder: Path, plant: str, left: str, right: str) -> Rig:
    """Left is stopped at its target in the zone, and the board of right has booted."""
    rig = Rig(read(folder, plant % (left, right), RECIPES))
    rig.wait(1.0)
    for robot in ("left", "right"):
        if rig.plant.dispatcher.obstacles.of(robot) is not None:
            rig.manual.put_at_reference(robot)
            rig.wait(1.0)
            rig.operate(Verb.HOME, robot, by_hand=True)
    rig.wait(5.0)
    rig.submit("aa go")
    rig.wait(4.0)
    rig.operate(Verb.STOP, "aa")
    rig.wait(1.0)
    rig.crash("right")
    rig.wait(1.0)
    return rig


@pytest.mark.parametrize(("plant", "left", "right"), [*product(PLANTS, HOMINGS, HOMINGS)])
def test_the_first_advice_leads_to_working_cells(tmp_path: Path, plant: str, left: str, right: str) -> None:
    file, cells = PLANTS[plant]
    rig = stopped_in_the_zone(tmp_path, file, HOMINGS[left], HOMINGS[right])
    for cell in cells:
        follow(rig, cell)
    assert all(works(rig, cell) for cell in cells)
    rig.submit("aa go")
    assert rig.wait(60.0, until=lambda: str(rig.changes[-1].state.value) == "done")


def test_a_robot_that_only_a_person_homes_is_taken_home_out_of_the_zone_first(tmp_path: Path) -> None:
    rig = stopped_in_the_zone(tmp_path, ONE_CELL, HOMINGS["assumed"], HOMINGS["by a routine"])
    for verb in (Verb.CLEAR, Verb.RESET):
        rig.operate(verb, "aa")
        rig.wait(2.0)
    assert advised(rig, "aa")[:2] == ["home left --by-hand", "home right"]


LONELY = plant_text(__file__, "zones_of_mobiles")
THERE_AND_BACK = """
from arboleda.recipes import recipe, work

@recipe("go")
def go(cell):
    one = cell.device("one")
    return work(one.go("far"), one.home())
"""


def test_a_person_who_puts_it_home_gives_back_its_zone_though_nobody_sees_it(tmp_path: Path) -> None:
    plant = Plant(read(tmp_path, LONELY.replace("joints", "state"), THERE_AND_BACK), epoch=7, now=0.0)
    assert plant.zones.acquire("one", frozenset({"gate"}))
    plant.step(0.1, [Report(at=0.1, robot="one", state=MotionState.STOPPED, epoch=1, plant=7)])
    assert plant.zones.holder("gate") == "one"
    by_hand = OperatorRequest(at=0.2, verb=Verb.HOME, scope="one", by_hand=True)
    plant.step(0.2, [by_hand])
    assert plant.zones.holder("gate") is None
