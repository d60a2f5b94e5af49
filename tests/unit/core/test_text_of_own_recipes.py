"""The grammar of tasks follows from the recipes of a cell: their names, parameters and words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest
from py_trees.behaviours import Success

from arboleda.model.errors import TextError
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.model.recipe import Parameter, Recipe
from arboleda.model.text import example, parse, spelled
from arboleda.testing import shipped

from ...plants import rows


def colours(cell: Cell) -> Sequence[str]:
    return ["red", "green"]


def programs(cell: Cell) -> Sequence[str]:
    return ["1001", "1002"]


def number(cell: Cell, word: str) -> int:
    return int(word)


PAINT = Recipe(
    name="paint",
    build=lambda order, context: Success("paint"),
    parameters=(
        Parameter(name="colour", words=colours),
        Parameter(name="program", words=programs, value=number),
    ),
)
REST = Recipe(name="rest", build=lambda order, context: Success("rest"), alone="arm")


def plant(*recipes: Recipe) -> PlantModel:
    """One cell that offers nothing but these."""
    model = shipped("sis_a")
    return replace(model, cells=(replace(model.cells[0], recipes=recipes),))


def refusal(text: str, *recipes: Recipe) -> str:
    with pytest.raises(TextError) as refused:
        parse(text, plant(*recipes))
    return str(refused.value)


def test_a_task_names_its_recipe_and_a_word_for_each_parameter() -> None:
    order = parse("SIS_A Paint RED 1002 #lot7", plant(PAINT, REST))
    assert (order.text, order.recipe, order.id) == ("sis_a paint red 1002", "paint", "lot7")
    assert order.values == {"colour": "red", "program": 1002}


def test_the_default_recipe_needs_no_name() -> None:
    painting = replace(PAINT, is_default=True)
    assert parse("sis_a green 1001", plant(painting, REST)).text == "sis_a green 1001"
    assert parse("ra1 rest", plant(painting, REST)).recipe == "rest"


def test_the_wrong_word_is_named_with_what_there_is_and_the_nearest() -> None:
    asked = refusal("sis_a paint gren 1001", PAINT)
    assert asked == "colour of sis_a cannot be 'gren'; there are red, green; did you mean green?"
    assert "program of sis_a cannot be '1003'; there are 1001, 1002" in refusal("sis_a paint red 1003", PAINT)
    assert "'pait' is not a recipe of sis_a; there are paint, rest; did you mean paint?" in refusal(
        "sis_a pait red 1001", PAINT, REST
    )


def test_a_task_without_a_recipe_names_those_there_are() -> None:
    assert "names no recipe of sis_a; there are paint, rest; write <cell> paint" in refusal(
        "sis_a", PAINT, REST
    )


@pytest.mark.parametrize("text", ["", "sis_a paint", "sis_a paint red", "sis_a paint red 1001 1"])
def test_the_form_is_told_with_an_example_that_is_taken(text: str) -> None:
    asked = refusal(text, PAINT, REST)
    form = "write <cell> paint <colour> <program>, e.g. sis_a paint red 1002, or <arm or cell> rest"
    assert asked.endswith(form)
    made = plant(PAINT, REST)
    order = example(made.cells[0], PAINT)
    assert parse(order.text, made) == order


def test_two_cells_may_offer_recipes_of_one_name() -> None:
    model = shipped("sis_a", "sis_b")
    first, second = model.cells
    other = replace(PAINT, parameters=PAINT.parameters[:1])
    both = replace(model, cells=(replace(first, recipes=(PAINT,)), replace(second, recipes=(other,))))
    assert parse("sis_a paint red 1001", both).values == {"colour": "red", "program": 1001}
    assert parse("sis_b paint green", both).values == {"colour": "green"}


def test_a_cell_that_offers_nothing_is_no_example() -> None:
    model = shipped("sis_a", "sis_b")
    first, second = model.cells
    idle = replace(model, cells=(replace(first, recipes=()), replace(second, recipes=(PAINT,))))
    with pytest.raises(TextError, match=r"e\.g\. sis_b paint red 1002"):
        parse("", idle)


def test_a_recipe_that_another_cell_offers_is_refused() -> None:
    model = shipped("sis_a", "sis_b")
    first, second = model.cells
    split = replace(model, cells=(replace(first, recipes=(PAINT,)), replace(second, recipes=(REST,))))
    with pytest.raises(TextError, match="'paint' is not a recipe of sis_b; there are rest"):
        parse("sis_b paint red 1001", split)


def test_a_task_without_a_recipe_is_shown_the_form_of_its_own_cell() -> None:
    model = shipped("sis_a", "sis_b")
    first, second = model.cells
    split = replace(
        model, cells=(replace(first, recipes=(PAINT, REST)), replace(second, recipes=(REST, PAINT)))
    )
    second_alone = replace(model, cells=(first, replace(second, recipes=(REST,))))
    with pytest.raises(TextError, match=r"there are rest; write <arm or cell> rest, e\.g\. sis_b rest$"):
        parse("sis_b", second_alone)
    with pytest.raises(TextError) as refused:
        spelled(split, cell="sis_a")
    form = "write <cell> paint <colour> <program>, e.g. sis_a paint red 1002, or <arm or cell> rest"
    named = '{"cell": "sis_a", "recipe": "paint", "values": {"colour": "red", "program": 1002}}'
    assert str(refused.value).endswith(f"there are paint, rest; {form}, or as JSON {named}")


def test_named_values_are_spelled_in_their_order() -> None:
    here = plant(PAINT, REST)
    values = {"program": 1002, "colour": "RED"}
    assert spelled(here, cell="SIS_A", recipe="Paint", values=values) == "sis_a paint red 1002"
    assert spelled(here, cell="sis_a", recipe="rest", id="#lot7") == "sis_a rest #lot7"


@pytest.mark.parametrize(
    ("asked", "sentence"),
    rows(__file__, "wrong_forms"),
)
def test_a_wrong_form_is_refused_with_the_word_that_is_wrong(asked: dict[str, Any], sentence: str) -> None:
    with pytest.raises(TextError) as refused:
        spelled(plant(PAINT, REST), cell="sis_a", **asked)
    assert str(refused.value).startswith(sentence)
