"""The page's plant with a place between two cells is one that `check` takes without a word."""

from __future__ import annotations

from pathlib import Path

import pytest

from ...plants import read

PAGES = Path(__file__).parents[3] / "docs/how-to"
RECIPES = """
from arboleda.recipes import recipe, work


@recipe("give")
def give(cell):
    arm = cell.device("arm")
    return work(arm.visit("shelf", arm.grip()), arm.visit("gate", arm.let_go()), arm.home())


@recipe("take")
def take(cell):
    arm = cell.device("arm")
    return work(arm.visit("gate", arm.grip()), arm.visit("bin", arm.let_go()), arm.home())
"""


@pytest.mark.parametrize(
    ("page", "heading"),
    [
        ("plant-file.md", "### A place between two cells"),
        ("plant-file.es.md", "### Un lugar entre dos celdas"),
    ],
)
def test_the_place_of_the_page_is_guarded(page: str, heading: str, tmp_path: Path) -> None:
    section = (PAGES / page).read_text("utf-8").partition(heading)[2]
    shown = section.partition("```yaml\n")[2].partition("```")[0]
    offers = shown.replace("  right:\n", "    recipes: [give]\n  right:\n").replace(
        "zones:", "    recipes: [take]\nzones:"
    )
    plant = read(tmp_path, f"name: hand_over\nuses: [recipes.py]\n{offers}", RECIPES)
    left, right = plant.cells
    assert {
        space.robot.name: [*space.targets["gate"].zones] for cell in plant.cells for space in cell.spaces
    } == {"left_arm": ["gate"], "right_arm": ["gate"]}
    assert [(each.device, each.other, each.fact) for cell in (left, right) for each in cell.needs] == [
        ("left_arm", "tray", "full"),
        ("right_arm", "tray", "full"),
    ]
