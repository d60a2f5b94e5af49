"""`check` warns of two targets at one place, of arms that can meet without a zone, and of nodes in a zone."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli

from ...plants import plant_text

PLANT = plant_text(__file__, "meeting_points")
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
        "bay: left and right can meet at middle and over (0 mm apart), which no zone has in common; "
        'put them into one zone, zones: {NAME: {poses: ["bay middle", "bay over"]}}'
    )


@pytest.mark.parametrize(
    "plant",
    [
        PLANT + ZONE,
        PLANT.replace("[2.19888, 0.08893]", "[2.27, 0.08893]"),
        PLANT.replace(", base: {origin_m: [2.19888, 0.08893], yaw_deg: 180}", "")
        .replace(", base: {origin_m: [0, 0]}", "")
        .replace(", grid: {origin_m: [1, 1]}", ""),
    ],
    ids=["a zone has both", "far enough", "nobody says where they stand"],
)
def test_nothing_is_told_where_they_cannot_or_nobody_knows(tmp_path: Path, plant: str) -> None:
    assert warned(tmp_path, plant) == []


def test_two_arms_that_come_within_the_width_of_a_hand_are_told(tmp_path: Path) -> None:
    (found,) = warned(tmp_path, PLANT.replace("[2.19888, 0.08893]", "[2.24888, 0.08893]"))
    assert "middle and over (50 mm apart)" in found


STANDS = {
    "one point": ("[0, 0]", "left and right stand in each other, 0 mm apart; give each its own place"),
    "50 mm": ("[0, 0.05]", "left and right stand in each other, 50 mm apart; give each its own place"),
    "left out": (
        "",
        "left and right stand in each other, 0 mm apart; right has no base and is at the origin",
    ),
}


@pytest.mark.parametrize(("origin", "said"), STANDS.values(), ids=STANDS)
def test_two_arms_that_stand_in_each_other_are_told_once(tmp_path: Path, origin: str, said: str) -> None:
    base = f", base: {{origin_m: {origin}}}" if origin else ""
    plant = PLANT.replace(", base: {origin_m: [2.19888, 0.08893], yaw_deg: 180}", base)
    assert warned(tmp_path, plant) == [f"bay: {said}; write base: {{origin_m: [x, y]}}"]


def with_cart(folder: Path, zone: str) -> list[str]:
    """What is said where the cart's node 5, `gate`, is below the place at which both arms can be."""
    plant = PLANT.replace("grid: {origin_m: [1, 1]}", "grid: {origin_m: [0.69944, -0.15554]}")
    return warned(folder, plant.replace("      far:", "      gate: {cart: {node: 5}}\n      far:") + zone)


def test_an_arm_and_a_mobile_robot_of_one_cell_meet_on_purpose_where_no_zone_is(tmp_path: Path) -> None:
    assert "cart" not in " ".join(with_cart(tmp_path, ""))
    assert with_cart(tmp_path, ZONE.replace("bay over", "bay over, bay gate")) == []


def test_a_mobile_robot_at_a_place_that_a_zone_guards_is_told(tmp_path: Path) -> None:
    assert with_cart(tmp_path, ZONE) == [
        "bay: left and cart can meet at middle and gate (0 mm apart), which no zone has in common; "
        'put them into one zone, zones: {table: {poses: ["bay middle", "bay gate"]}}',
        "bay: right and cart can meet at over and gate (0 mm apart), which no zone has in common; "
        'put them into one zone, zones: {table: {poses: ["bay over", "bay gate"]}}',
    ]


def test_two_targets_at_one_place_are_told(tmp_path: Path) -> None:
    more = "      again: {left: {deg: [100, 10], mm: 80}}\n      there: {cart: {node: 3}}\n"
    assert warned(tmp_path, PLANT + more + ZONE) == [
        "bay: far and again of left are one place; move one of them, or delete it",
        "bay: far and there of cart are one place; move one of them, or delete it",
    ]


def test_two_heights_over_one_place_are_two_targets(tmp_path: Path) -> None:
    more = "      again: {left: {deg: [100, 10], mm: 80, approach_mm: 20}}\n"
    assert warned(tmp_path, PLANT + more + ZONE) == []


RACK = plant_text(__file__, "meeting_points_rack")


def test_a_station_where_parts_are_picked_up_is_told_and_two_exits_may_be_met_at_one_place(
    tmp_path: Path,
) -> None:
    told = [each for each in warned(tmp_path, RACK) if "one place" in each]
    mend = "; move one of them, or delete it"
    alike = [f"{pickup} and station_0 of arm are one place" for pickup in ("pickup", "pickup_1")]
    assert told == [f"lab: {each}{mend}" for each in alike]


CROSSING = plant_text(__file__, "grid_check")


def test_the_node_is_told_with_what_keeps_the_other_off(tmp_path: Path) -> None:
    (found,) = warned(tmp_path, CROSSING)
    assert found == (
        "left is at gate in crossing, and nothing keeps two off its node 1 there;"
        " a target of two at it, in that zone, does"
    )


@pytest.mark.parametrize(
    "plant",
    [
        CROSSING.replace("{left: {node: 5}}", "{left: {node: 5}, two: {node: 1}}"),
        CROSSING.replace("[0.4, 0]", "[5, 0]"),
        CROSSING.replace("zones:\n  crossing: {poses: [bay gate]}\n", ""),
    ],
    ids=["a target in the zone", "elsewhere", "no zone"],
)
def test_nothing_is_told_where_nobody_comes_by(tmp_path: Path, plant: str) -> None:
    assert warned(tmp_path, plant) == []
