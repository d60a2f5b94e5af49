"""A place of two cells: an output of one and an ordinary place of the other; the place that a page shows."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.plant_model import PlantModel
from arboleda.plant_check import advance_check, place_check

from ...plants import plant_text, read

PLANT = plant_text(__file__, "common_outputs")
RECIPES = """
from arboleda.recipes import recipe, work

def carried(cell, start, end):
    arm, jaw = cell.devices("arm", "jaw")
    take = arm.visit(start, jaw.close(width_mm=30, force_n=20))
    return work(take, arm.visit(end, jaw.open()), arm.home())

@recipe("make")
def make(cell):
    return work(cell.device("former").read(), carried(cell, "in", "rack"))

@recipe("clean")
def clean(cell):
    return work(cell.device("washer").read(), carried(cell, "rack", "bin"))
"""


def rack(folder: Path, plant: str = PLANT) -> PlantModel:
    return read(folder, plant, RECIPES)


def test_check_has_nothing_against_it(tmp_path: Path) -> None:
    plant = rack(tmp_path)
    assert (place_check.warnings(plant), advance_check.warnings(plant)) == ((), ())


@pytest.mark.parametrize(
    ("here", "there"),
    [
        ("bin: {holds: 50, output: true}", "bin: {holds: 50, output: true}"),  # a place of this cell alone
        ("rack: {holds: 2}", "rack: {holds: 2, output: true}"),
        ("rack: {holds: 2}", "rack: {holds: 2, supply: true}"),
    ],
    ids=["of one cell", "an output in both", "a supply of the other"],
)
def test_other_outputs_are_emptied_by_people(tmp_path: Path, here: str, there: str) -> None:
    plant = PLANT.replace(f"{here},", f"{there},").replace(f"{here}}}", f"{there}}}")
    press, wash = rack(tmp_path, plant).cells
    cell, target = (wash, "bin") if here.startswith("bin") else (press, "rack")
    assert next(place.output for place in cell.places if place.target == target)


PAGES = Path(__file__).parents[3] / "docs/how-to"
GIVE_AND_TAKE = """
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
    plant = read(tmp_path, f"name: hand_over\nuses: [recipes.py]\n{offers}", GIVE_AND_TAKE)
    left, right = plant.cells
    assert {
        space.robot.name: [*space.targets["gate"].zones] for cell in plant.cells for space in cell.spaces
    } == {"left_arm": ["gate"], "right_arm": ["gate"]}
    assert [(each.device, each.other, each.fact) for cell in (left, right) for each in cell.needs] == [
        ("left_arm", "tray", "full"),
        ("right_arm", "tray", "full"),
    ]
