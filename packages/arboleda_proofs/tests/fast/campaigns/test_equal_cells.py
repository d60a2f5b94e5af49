"""Cells that are equal but for their names are proved once."""

from __future__ import annotations

from pathlib import Path
from typing import Any

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


def plant(folder: Path, text: str) -> Any:
    (folder / "recipes.py").write_text(SHINE, "utf-8")
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
