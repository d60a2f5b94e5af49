"""New trees in which a part is carried: with a robot's own hand, with a tool, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ArboledaError
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.plant_check import advance_check
from arboleda.plant_file.loader import load
from arboleda_make.editing import carry, desk

EXAMPLES = Path(__file__).parents[5] / "examples"
PLANT = """name: lab
uses: [t.xml]
cells:
  lab:
    devices: {arm: {kind: arm, model: scara}}
    targets:
      home: {arm: {deg: [0, 0], mm: 0}}
      feed: {arm: {deg: [60, 20], mm: 80}}
      tray: {arm: {deg: [-45, 20], mm: 80}}
"""
EMPTY = '<root BTCPP_format="4"><BehaviorTree ID="T"><arm_home/></BehaviorTree></root>'


@pytest.fixture
def lab(tmp_path: Path) -> PlantModel:
    (tmp_path / "plant.yaml").write_text(PLANT)
    (tmp_path / "t.xml").write_text(EMPTY)
    return load(tmp_path / "plant.yaml")


def nodes(model: PlantModel, cell: Cell, text: str) -> list[str]:
    drawn = desk.drawn(model, cell.name, text)
    assert drawn["marks"] == []
    return [each["kind"] for each in drawn["trees"][0]["nodes"]]


def test_a_robot_takes_a_part_with_its_own_hand(lab: PlantModel) -> None:
    cell = lab.cells[0]
    text = carry.tree(cell, "to_tray", robot="arm", start="feed", end="tray")
    assert nodes(lab, cell, text) == [
        "Sequence", "arm_visit", "arm_grip", "arm_visit", "arm_let_go", "arm_home"
    ]  # fmt: skip
    assert '<BehaviorTree ID="ToTray" _description="Take a part from feed to tray.">' in text


def test_a_tool_is_told_its_own_verbs_with_values_that_it_takes() -> None:
    model = load(EXAMPLES / "own_tree/plant.yaml")
    cell = model.cells[0]
    text = carry.tree(cell, "out", robot="loader", start="vise", end="done")
    assert nodes(model, cell, text)[1:5] == ["loader_visit", "jaw_close", "loader_visit", "jaw_open"]
    assert [*carry.carriers(cell)] == ["loader"]


@pytest.mark.parametrize(
    ("robot", "end", "why"),
    [("lamp", "tray", "has nothing to take a part with"), ("arm", "moon", "no target of arm")],
)
def test_who_cannot_carry_it_there_is_refused(lab: PlantModel, robot: str, end: str, why: str) -> None:
    with pytest.raises(ArboledaError, match=why):
        carry.tree(lab.cells[0], "x", robot=robot, start="feed", end=end)


@pytest.mark.parametrize(
    ("start", "end", "ends"),
    [("feed", "press", "press: 1"), ("press", "tray", "press: 0"), ("feed", "tray", "")],
)
def test_what_it_leaves_in_a_device_is_stated_so_that_check_warns_of_nothing(
    tmp_path: Path, start: str, end: str, ends: str
) -> None:
    press = (
        "      press: {arm: {deg: [10, 20], mm: 80}}\n    places: {feed: {supply: true}, press: {of: oven}}\n"
    )
    kind = "kinds: {oven: {facts: {hot: bool}, verbs: {heat: {effect: switch, sets: {hot: true}}}}}\ncells:"
    text = (PLANT + press).replace("cells:", kind).replace("scara}}", "scara}, oven: {kind: oven}}")
    (tmp_path / "plant.yaml").write_text(text)
    (tmp_path / "t.xml").write_text(EMPTY)
    cell = load(tmp_path / "plant.yaml").cells[0]
    made = carry.tree(cell, "to_tray", robot="arm", start=start, end=end)
    assert made.count(f'ends_with="{ends}"') == bool(ends)
    (tmp_path / "t.xml").write_text(made)
    assert advance_check.warnings(load(tmp_path / "plant.yaml")) == ()
