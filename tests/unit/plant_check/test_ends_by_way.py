"""Ends of a recipe by the way it goes, and of what cells share as a task gives it back."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_check import advance_check

from ...plants import plant_text, read

PLANT = plant_text(__file__, "ends_by_way")
RECIPES = """
from arboleda.recipes import recipe, work

@recipe("sort", ends_with=ENDS)
def sort(cell):
    arm, jaw, camera = cell.devices("arm", "jaw", "camera")
    seen, take = camera.look(), arm.visit("in", jaw.close(width_mm=30, force_n=20))
    ways = {"good": arm.visit("GOOD", jaw.open()), "bad": arm.visit("BAD", jaw.open())}
    return work(seen, take, cell.choose(seen, ways), arm.home())
"""
ASKS_TWICE = """
from arboleda.recipes import recipe, work

@recipe("sort", ends_with=ENDS)
def sort(cell):
    arm, jaw, camera = cell.devices("arm", "jaw", "camera")
    before, take = camera.look(), arm.visit("in", jaw.close(width_mm=30, force_n=20))
    after = camera.look()
    ways = {"good": arm.visit("GOOD", jaw.open()), "bad": arm.visit("BAD", jaw.open())}
    homes = {"good": arm.home(), "bad": arm.home()}
    return work(before, take, after, cell.choose(after, ways), cell.choose(before, homes))
"""
SELDOM = """
from arboleda.recipes import Choice, recipe, work

@recipe("sort", ends_with=ENDS)
def sort(cell, one=Choice(*WORDS), other=Choice(*WORDS)):
    arm, jaw = cell.devices("arm", "jaw")
    place = "reject" if (one, other) == ("a", WORDS[-1]) else "press"
    return work(arm.visit("in", jaw.close(width_mm=30, force_n=20)), arm.visit(place, jaw.open()), arm.home())
"""
FEW, MANY = "abc", "abcdefghijklmno"  # values of each of two parameters
BY_ANSWER = '[{"camera.look": "good", "press": 1}, {"camera.look": "bad", "reject": 1}]'
EITHER = '[{"press": 1}, {"reject": 1}]'
RIGHT, SWAPPED, ONE_PLACE = ("press", "reject"), ("reject", "press"), ("press", "press")


def sorting(
    folder: Path,
    ends: str,
    ways: tuple[str, str] = RIGHT,
    *,
    recipe: str = RECIPES,
    plant: str = PLANT,
    name: str = "recipes.py",
) -> PlantModel:
    text = recipe.replace("ENDS", ends).replace("GOOD", ways[0]).replace("BAD", ways[1])
    (folder / name).write_text(text, "utf-8")
    return read(folder, plant.replace("USES", name))


def warned(plant: PlantModel) -> list[str]:
    return [each.split(" sort ", 1)[1].partition(";")[0] for each in advance_check.warnings(plant)]


@pytest.mark.parametrize("ends", [BY_ANSWER, EITHER], ids=["by answer", "either"])
def test_nothing_is_said_against_a_recipe_that_ends_as_it_says_on_each_way(tmp_path: Path, ends: str) -> None:
    assert warned(sorting(tmp_path, ends)) == []


PARTS_SWAPPED = [
    "ends with press 0, and says that it ends with 1",
    "ends with reject 0, and says that it ends with 1",
    "says that it may end with camera.look good and press 1, and never ends so",
    "says that it may end with camera.look bad and reject 1, and never ends so",
]


def test_check_finds_the_parts_of_two_answers_swapped(tmp_path: Path) -> None:
    assert warned(sorting(tmp_path, BY_ANSWER, SWAPPED)) == PARTS_SWAPPED


def test_only_the_last_question_to_a_device_has_its_last_answer(tmp_path: Path) -> None:
    assert warned(sorting(tmp_path, BY_ANSWER, recipe=ASKS_TWICE)) == []
    swapped = warned(sorting(tmp_path, BY_ANSWER, SWAPPED, recipe=ASKS_TWICE))
    assert "ends with press 0, and says that it ends with 1" in swapped


def test_check_finds_an_end_that_no_way_has(tmp_path: Path) -> None:
    plant = sorting(tmp_path, EITHER, ONE_PLACE)
    assert warned(plant) == ["says that it may end with reject 1, and never ends so"]


@pytest.mark.parametrize("words", [FEW, MANY])
def test_nothing_is_said_against_an_end_that_one_task_of_all_has(tmp_path: Path, words: str) -> None:
    recipe = SELDOM.replace("WORDS", repr(words))
    assert warned(sorting(tmp_path, EITHER, recipe=recipe)) == []


def test_an_end_that_was_not_met_is_named_where_all_tasks_were_tried(tmp_path: Path) -> None:
    recipe = SELDOM.replace("WORDS", repr(FEW)).replace('"reject" if', '"press" if')
    plant = sorting(tmp_path, EITHER, recipe=recipe)
    assert warned(plant) == ["says that it may end with reject 1, and never ends so"]


def test_check_says_the_ends_of_all_ways(tmp_path: Path) -> None:
    (said,) = advance_check.ends(sorting(tmp_path, BY_ANSWER))
    ways = "camera.look good and press 1 or camera.look bad and reject 1 (it says so)"
    assert said.startswith(f"a: sort ends with {ways}, ")


@pytest.mark.parametrize(
    ("ends", "sentence"),
    [
        ('[{"camera.look": "fine"}]', "sort ends with 'fine' of camera.look, which answers good, bad"),
        ('[{"camera.loko": "bad"}]', "sort ends with 'camera.loko'"),
        ('["press"]', "sort: ends_with is \"['press']\"; write "),
    ],
)
def test_what_no_way_can_end_with_is_refused(tmp_path: Path, ends: str, sentence: str) -> None:
    with pytest.raises(ConfigError) as refused:
        sorting(tmp_path, ends)
    assert sentence in str(refused.value)


SHARED = plant_text(__file__, "shared_ends")
GIVES_BACK = """
from arboleda.recipes import recipe, work

@recipe("do", ends_with=ENDS)
def do(cell):
    clock, stand = cell.devices("clock", "stand")
    hour = clock.read()
    return BODY
"""
GIVES = "a: do gives stand back with a part in it, and fails there; "
HOLDS = f"{GIVES}write stand.lock(on=False) before"


def checked(folder: Path, body: str, ends: str = "{}") -> tuple[list[str], list[str]]:
    """What is warned of, and what is said of the end."""
    plant = read(folder, SHARED, GIVES_BACK.replace("BODY", body).replace("ENDS", ends))
    warned = [each.split(":1: ")[1] for each in advance_check.warnings(plant)]
    return warned, list(advance_check.ends(plant))


@pytest.mark.parametrize(
    ("body", "ends"),
    [
        ("stand.lock(on=True)", "{}"),
        ("stand.lock(on=True)", "{'stand.locked': True}"),
        ("work(hour, cell.choose(hour, {'day': stand.lock(on=True), 'night': stand.lock(on=False)}))", "{}"),
        ("work(cell.using('stand', stand.lock(on=True)), cell.using('stand', stand.lock(on=False)))", "{}"),
    ],
    ids=["forgotten", "meant", "on one way", "between two times"],
)
def test_a_shared_device_that_is_given_back_with_a_part_is_told(tmp_path: Path, body: str, ends: str) -> None:
    assert checked(tmp_path, body, ends)[0] == [HOLDS]


def test_nothing_is_told_where_it_lets_go_before(tmp_path: Path) -> None:
    assert checked(tmp_path, "work(stand.lock(on=True), hour, stand.lock(on=False))")[0] == []


@pytest.mark.parametrize(
    ("night", "when"),
    [
        ("stand.lift(to='high')", "when stand is given back (it says so)"),
        ("[]", "when stand is given back, by a task that takes it (it says so)"),
    ],
)
def test_the_end_of_a_shared_device_is_that_of_a_task_that_takes_it(
    tmp_path: Path, night: str, when: str
) -> None:
    ways = f"{{'day': stand.lift(to='high'), 'night': {night}}}"
    body = f"work(hour, cell.choose(hour, {ways}))"
    warned, ends = checked(tmp_path, body, "{'stand.at': 'high'}")
    assert (warned, ends) == ([], [f"a: do ends with stand.at high {when}"])
