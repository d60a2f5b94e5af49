"""Cells that are equal but for their names are proved once, and the answer says which."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from arboleda.cli.main import main
from arboleda.plant_file.loader import load
from arboleda_proofs.campaigns.proof.equal_cells import equal_cells, notes
from arboleda_proofs.campaigns.proof.scenario import scenarios

TWO = """
name: two
uses: [recipes.py]
kinds: {lamp: {facts: {lit: bool}, verbs: {light: {effect: switch, sets: {lit: true}}}}}
shared: {buzzer: {kind: lamp}}
cells:
  left: {devices: {lamp: {kind: lamp, name: lamp_1}, buzzer: {shared: buzzer}}}
  right: {devices: {lamp: {kind: lamp, name: lamp_2}, buzzer: {shared: buzzer}}}
"""
SHINE = """
from arboleda.recipes import recipe, work

@recipe("shine")
def shine(cell):
    return work(cell.device("lamp").light())
"""
PRESSES = """
name: presses
uses: [recipes.py]
kinds: {press: {facts: {ram: [up, down]}, verbs: {light: {effect: motion, sets: {ram: up}, takes_s: 1}}}}
cells:
  left:
    devices: {arm: {kind: arm, model: scara, name: arm_1}, lamp: {kind: press, name: press_1}}
    targets: {home: {arm: {deg: [0, 0], mm: 0}}, nest: {arm: {deg: [60, 20], mm: 0}}}
  right:
    devices: {arm: {kind: arm, model: scara, name: arm_2}, lamp: {kind: press, name: press_2}}
    targets: {home: {arm: {deg: [0, 0], mm: 0}}, nest: {arm: {deg: [60, 20], mm: 0}}}
zones:
  nest: {poses: [left nest, right nest]}
"""
CARRY = """
from arboleda.recipes import recipe, work

@recipe("carry", ends_with={"lamp.lit": False})
def carry(cell):
    arm, jaw, lamp = cell.devices("arm", "jaw", "lamp")
    arm.brings_back_to("bin")
    taken = arm.visit("in", jaw.close(width_mm=30, force_n=20)), arm.visit("bin", jaw.open()), arm.home()
    return work(lamp.light(on=True), cell.using(["arm", "jaw"], *taken), lamp.light(on=False))
"""
FIVE = """
name: five
uses: [recipes.py]
kinds: {lamp: {facts: {lit: bool}, verbs: {light: {effect: switch, with: {on: bool}, sets: {lit: $on}}}}}
shared: {arm: {kind: arm, model: scara}, jaw: {kind: gripper, tool_of: arm}}
cells:
"""
ONE_OF_FIVE = """
  {name}:
    devices: {{arm: {{shared: arm}}, jaw: {{shared: jaw}}, lamp: {{kind: lamp, name: lamp_{name}}}}}
    targets:
      home: {{arm: {{deg: [0, 0], mm: 0}}}}
      in: {{arm: {{deg: [60, 20], mm: 50}}}}
      bin: {{arm: {{deg: [-60, 20], mm: 50}}}}
    places: {{in: {{supply: true}}, bin: {{holds: 50, output: true}}}}
    zone_wait_s: 600
"""


def plant(folder: Path, text: str, recipes: str = SHINE) -> Any:
    (folder / "recipes.py").write_text(recipes, "utf-8")
    (folder / "plant.yaml").write_text(text, "utf-8")
    return load(folder / "plant.yaml")


def test_names_of_cells_and_of_their_own_devices_make_no_difference(tmp_path: Path) -> None:
    model = plant(tmp_path, TWO)
    assert equal_cells(model) == {"left": "left", "right": "left"}
    assert [each.cell for each in scenarios(model)] == ["left"]
    assert [*notes(model)] == ["equal to left but for names, so proved once, in left: right"]


def test_anything_else_does(tmp_path: Path) -> None:
    model = plant(tmp_path, TWO.replace("name: lamp_2}", "name: lamp_2, evidence: joints}"))
    assert equal_cells(model) == {"left": "left", "right": "right"}
    assert [each.cell for each in scenarios(model)] == ["left", "right"]
    assert not [*notes(model)]


def test_a_zone_that_waits_for_the_device_of_one_cell_is_a_difference(tmp_path: Path) -> None:
    both = plant(tmp_path, PRESSES)
    assert equal_cells(both) == {"left": "left", "right": "left"}
    of_left = PRESSES.replace("right nest]", "right nest], free_while: {press_1: {ram: up}}")
    assert equal_cells(plant(tmp_path, of_left)) == {"left": "left", "right": "right"}


def test_a_recipe_that_does_otherwise_by_the_name_of_a_device_is_a_difference(tmp_path: Path) -> None:
    by_name = SHINE.replace(
        'work(cell.device("lamp").light())',
        'work(*[cell.wait(1)] * ("lamp_1" in cell.device("lamp").light().name), cell.device("lamp").light())',
    )
    assert equal_cells(plant(tmp_path, TWO, by_name)) == {"left": "left", "right": "right"}


def test_five_cells_that_share_an_arm_are_proved_once_and_the_answer_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    model = plant(tmp_path, FIVE + "".join(ONE_OF_FIVE.format(name=name) for name in "abcde"), CARRY)
    assert equal_cells(model) == dict.fromkeys("abcde", "a")
    words = ["--fault", "operator_release", "--jobs", "1", "--state", str(tmp_path), "--json", "-"]
    monkeypatch.setattr("sys.argv", ["arboleda", "prove", str(tmp_path / "plant.yaml"), *words])
    with pytest.raises(SystemExit):
        main()
    answer = json.loads(capsys.readouterr().out.splitlines()[-1])["answer"]
    assert answer["proved_as"] == dict.fromkeys("bcde", "a")
    assert {each["cell"] for each in answer["scenarios"]} == {"a"}
