"""`check` warns of two targets of one robot at one place, and of two arms that can meet without a zone."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli

PLANT = """
name: pair
uses: [recipes.py]
cells:
  bay:
    devices:
      left:  {kind: arm, model: scara, base: {origin_m: [0, 0]}}
      right: {kind: arm, model: scara, base: {origin_m: [2.19888, 0.08893], yaw_deg: 180}}
      cart:  {kind: mobile, grid: {origin_m: [1, 1]}}
    targets:
      home:   {left: {deg: [90, 0], mm: 0}, right: {deg: [90, 0], mm: 0}, cart: {node: 0}}
      middle: {left: {deg: [20, -40], mm: 80}}
      over:   {right: {deg: [20, -40], mm: 80}}
      far:    {left: {deg: [100, 10], mm: 80}, cart: {node: 3}}
"""
RECIPES = """
from arboleda.recipes import recipe

@recipe("go")
def go(cell):
    return cell.device("left").go("middle")
"""
ZONE = "zones:\n  table: {poses: [bay middle, bay over]}\n"


def warned(folder: Path, plant: str) -> list[str]:
    (folder / "recipes.py").write_text(RECIPES)
    (folder / "plant.yaml").write_text(plant)
    said = CliRunner().invoke(cli, ["check", str(folder / "plant.yaml")])
    assert said.exit_code == 0, said.output
    return [line.partition("warning: ")[2] for line in said.output.splitlines() if "warning: " in line]


def test_two_arms_that_can_meet_are_told_with_their_targets(tmp_path: Path) -> None:
    (found,) = warned(tmp_path, PLANT)
    assert found == (
        "bay: left and right can meet at middle and over (0 mm apart), which no zone has in common"
    )


@pytest.mark.parametrize(
    "plant",
    [
        PLANT + ZONE,
        PLANT.replace("[2.19888, 0.08893]", "[2.22, 0.08893]"),
        PLANT.replace("origin_m: [2.19888, 0.08893], yaw_deg: 180", "origin_m: [0, 0]"),
    ],
    ids=["a zone has both", "far enough", "nobody says where they stand"],
)
def test_nothing_is_told_where_they_cannot_or_nobody_knows(tmp_path: Path, plant: str) -> None:
    assert warned(tmp_path, plant) == []


def test_two_targets_at_one_place_are_told(tmp_path: Path) -> None:
    more = "      again: {left: {deg: [100, 10], mm: 80}}\n      there: {cart: {node: 3}}\n"
    assert warned(tmp_path, PLANT + more + ZONE) == [
        "bay: far and again of left are one place",
        "bay: far and there of cart are one place",
    ]


def test_two_heights_over_one_place_are_two_targets(tmp_path: Path) -> None:
    more = "      again: {left: {deg: [100, 10], mm: 80, approach_mm: 20}}\n"
    assert warned(tmp_path, PLANT + more + ZONE) == []
