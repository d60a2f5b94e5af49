"""Forms of the tasks that cells offer: each recipe with its parameters and their values."""

from __future__ import annotations

from typing import Any

from arboleda.model.plant_model import Cell, PlantModel
from arboleda.model.recipe import Parameter, Recipe
from arboleda.model.sentence import OWN
from arboleda.model.text import example

Row = dict[str, Any]


def offers(model: PlantModel) -> list[Row]:
    """The recipes of each cell, by its name."""
    return [{"cell": cell.name, "recipes": recipes(cell)} for cell in model.cells]


def recipes(cell: Cell) -> list[Row]:
    """The recipes of a cell, beginning with the one for tasks that name none."""
    return [_recipe(cell, each) for each in sorted(cell.recipes, key=lambda each: not each.is_default)]


def _recipe(cell: Cell, recipe: Recipe) -> Row:
    return {
        "name": recipe.name,
        "about": recipe.about,
        "default": recipe.is_default,
        "form": str(recipe.form()),
        "example": example(cell, recipe).text,
        "parameters": [_parameter(cell, each) for each in recipe.parameters],
    }


def _parameter(cell: Cell, parameter: Parameter) -> Row:
    called = parameter.called() if parameter.called else OWN(text=parameter.name)
    return {"name": parameter.name, "called": called, **_can_be(cell, parameter)}


def _can_be(cell: Cell, parameter: Parameter) -> Row:
    """The type of a parameter, with the words of a choice or the limits of a number."""
    limits = parameter.limits(cell)
    if limits is None:
        return {"type": "choice", "choices": list(parameter.words(cell))}
    kind = "integer" if limits.whole else "number"
    return {"type": kind, "lower": limits.lower, "upper": limits.upper, "choices": []}
