"""What `check` warns of: places that nothing guards, devices of parts without one, places that are two."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.plant_check import place_check

from ...plants import changed, plant_text, read, rows

PLANT = plant_text(__file__, "place_check")
RECIPES = """
from arboleda.recipes import recipe, work

@recipe("try")
def attempt(cell):
    return work(cell.device("left").home())
"""
IN_THE_OVEN = "  in_the_oven: {poses: [lab inside], free_while: {oven: {door: open}}}\n"
NEEDS = "    needs: {left.go: {oven.door: open}}\nzones:\n"


def warned(folder: Path, *edits: tuple[str, str]) -> tuple[str, ...]:
    return place_check.warnings(read(folder, changed(PLANT, *edits), RECIPES))


def test_nothing_is_wrong_with_a_plant_that_says_all(tmp_path: Path) -> None:
    assert warned(tmp_path) == ()


@pytest.mark.parametrize(("edit", "sentence"), rows(__file__, "places"))
def test_it_warns(tmp_path: Path, edit: tuple[str, str], sentence: str) -> None:
    assert warned(tmp_path, edit) == (sentence,)


def test_a_need_guards_a_place_as_a_zone_does(tmp_path: Path) -> None:
    assert warned(tmp_path, (IN_THE_OVEN, ""), ("zones:\n", NEEDS)) == ()


def test_a_need_that_asks_nothing_of_the_robot_guards_no_place(tmp_path: Path) -> None:
    needs = "    needs: {oven.close: {jaw.gripped: false}}\nzones:\n"
    (warning,) = warned(tmp_path, (IN_THE_OVEN, ""), ("zones:\n", needs))
    assert "nothing keeps left out of there" in warning


COMMON = plant_text(__file__, "place_check_common")
CELL = """
  NAME:
    devices: {eye: {kind: sensor, name: eye_NAME, answers: [x, y]}, arm: {shared: arm}}
    targets: {home: {arm: {deg: [0, 0], mm: 0}}, seat: {arm: {deg: [40, 20], mm: 50}}}
    places: {seat: WORDS}
"""
LOOK = """
from arboleda.recipes import recipe

@recipe("look")
def look(cell):
    return cell.device("eye").read()
"""


def said_of_seat(folder: Path, *words: str) -> list[str]:
    cells = [
        CELL.replace("NAME", name).replace("WORDS", each) for name, each in zip("abcd", words, strict=False)
    ]
    plant = read(folder, COMMON + "".join(cells), LOOK)
    return [each for each in place_check.warnings(plant) if "seat" in each]


def test_one_place_that_four_cells_describe_differently_is_told_once(tmp_path: Path) -> None:
    assert said_of_seat(tmp_path, "{}", "{holds: 2}", "{holds: 2}", "{supply: true}") == [
        "a, b, c, d: seat is one place of these cells, and is {holds: 1} (a), {holds: 2} (b, c), "
        "{holds: 1, supply: true} (d); write the same in each"
    ]


def test_people_cannot_both_fill_and_empty_one_place(tmp_path: Path) -> None:
    assert len(said_of_seat(tmp_path, "{supply: true}", "{output: true}")) == 1


@pytest.mark.parametrize("other", ["{}", "{output: true}"])
def test_an_output_may_be_a_plain_place_of_another_cell(tmp_path: Path, other: str) -> None:
    assert said_of_seat(tmp_path, "{output: true}", other) == []
