"""What `check` tells once of several cells, and needs that no device can ever meet."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from arboleda.model.errors import ConfigError
from arboleda.plant_check import checks
from arboleda.plant_file import loader
from arboleda.plant_file.problems import counted, told_once

from ...plants import plant_text, read

PLANT = """
name: lights
uses: [recipes.py]
kinds:
  lamp: {{facts: {{lit: bool}}, verbs: {{light: {{effect: switch, with: {{on: bool}}, sets: {{lit: $on}}}}}}}}
cells:
  hall: {{devices: {{lamp: {{kind: lamp}}}}}}
  yard: {{devices: {{lamp: {{kind: lamp, name: yard_lamp}}}}}}{more}
"""
DOOR = "\n  shop: {devices: {door: {kind: lamp}}}"
HEAD = "from arboleda.recipes import recipe\n\n@recipe('shine')\ndef shine(cell):\n    "


def plant(folder: Path, body: str, more: str = "") -> Path:
    (folder / "recipes.py").write_text(HEAD + body, "utf-8")
    file = folder / "plant.yaml"
    file.write_text(PLANT.format(more=more), "utf-8")
    return file


def test_a_recipe_that_fits_no_cell_is_told_once_for_those_in_which_it_is_alike(tmp_path: Path) -> None:
    with pytest.raises(ConfigError) as refusal:
        loader.load(plant(tmp_path, "return cell.device('lmp').light(on=True)", DOOR))
    assert [each.removeprefix(f"{tmp_path}/") for each in refusal.value.problems] == [
        "recipes.py:5:1: hall, yard: shine: hall has no device in the role 'lmp'; there are lamp; "
        "did you mean lamp?",
        "recipes.py:5:1: shine: shop has no device in the role 'lmp'; there are door",
    ]


def test_a_warning_of_a_recipe_is_told_once_for_its_cells(tmp_path: Path) -> None:
    file = plant(tmp_path, "return cell.retry(cell.wait(1), times=1000, pause_s=9)")
    (found,) = checks.warnings(loader.load(file))
    assert f"{tmp_path}/recipes.py:3:1: hall, yard: shine tries " in found


@pytest.mark.parametrize(
    "sentences",
    [
        ("hall: hall is open", "yard: yard is open"),
        ("hall.yaml:1:1: it is dark", "yard.yaml:1:1: it is dark"),
        ("p.yaml:1:1: hall: it is dark", "p.yaml:2:1: yard: it is dark"),
        ("hall_1 is dark", "yard_1 is dark"),
    ],
    ids=["a device", "a file", "a line", "a part of a name"],
)
def test_what_differs_in_more_than_the_cell_is_told_of_each(sentences: tuple[str, ...]) -> None:
    assert told_once(sentences, ["hall", "yard"]) == sentences


def test_what_a_file_has_in_place_of_a_cells_name_is_taken_as_it_is_written() -> None:
    names: list[Any] = ["a[", 1, ".*"]
    sentences = ("a[: it is dark", "1: it is dark", "hall: it is light")
    assert told_once(sentences, names) == sentences


PRESSES = plant_text(__file__, "told_once_presses")


def test_one_mistake_in_three_cells_whose_devices_have_other_names_is_one_line_with_a_count(
    tmp_path: Path,
) -> None:
    body = "press = cell.device('press')\n    return work(press.open(), press.press())"
    file = plant(tmp_path, body)
    (tmp_path / "recipes.py").write_text(HEAD.replace("import recipe", "import recipe, work") + body)
    file.write_text(PRESSES)
    (found,) = checks.warnings(loader.load(file))
    assert found.removeprefix(f"{tmp_path}/") == (
        "recipes.py:3:1: a, b, c: shine has press_a press, which needs door of press_a to be shut, "
        "where it is open; write press.shut() before (3 times)"
    )


def test_devices_of_other_roles_are_no_one_mistake() -> None:
    roles = {"a": {"left": "one"}, "b": {"right": "other"}}
    assert counted(("a: left is wet", "b: right is wet"), roles) == ("a: left is wet", "b: right is wet")


NEEDY = """
name: lab
uses: [recipes.py]
kinds:
  oven:
    facts: {{door: [closed, open]}}
    verbs:
      open: {{effect: motion, sets: {{door: open}}}}
      bake: {{effect: process, takes_s: 2{own}}}
  mill:
    facts: {{guard: [shut, up]}}
    verbs:
      turn: {{effect: process, takes_s: 2, sets: {{guard: shut}}}}
cells:
  lab:
    devices:
      oven: {{kind: oven, evidence: {evidence}}}
      mill: {{kind: mill}}
    needs: {{mill.turn: {{oven.door: open}}}}
"""
TURN = """
from arboleda.recipes import recipe

@recipe("turn")
def turn(cell):
    return cell.device("mill").turn()
"""
OWN = ", needs: {door: open}"
SILENT = "of oven, and oven reports no facts (evidence: state); it is always refused; write another evidence"


@pytest.mark.parametrize(
    ("own", "evidence", "said"),
    [
        ("", "ids", []),
        (OWN, "facts", []),
        ("", "state", [f"lab: mill turn needs door {SILENT}"]),
        (OWN, "state", [f"lab: oven bake needs door {SILENT}", f"lab: mill turn needs door {SILENT}"]),
    ],
)
def test_it_names_verbs_that_need_what_a_device_never_reports(
    tmp_path: Path, own: str, evidence: str, said: list[str]
) -> None:
    plant = read(tmp_path, NEEDY.format(own=own, evidence=evidence), TURN)
    assert list(checks.unmet_needs(plant)) == said
