"""What cells offer as forms: each recipe with its parameters, and what these can be."""

from __future__ import annotations

from typing import Any

from arboleda.core.text import example
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.model.recipe import Parameter, Recipe
from arboleda.model.sentence import OWN

Row = dict[str, Any]


def offers(model: PlantModel) -> list[Row]:
    """By cell, what can be asked of it."""
    return [{"cell": cell.name, "recipes": recipes(cell)} for cell in model.cells]


def recipes(cell: Cell) -> list[Row]:
    """Each recipe of a cell, the one first that a task means which names none."""
    return [_recipe(cell, each) for each in sorted(cell.recipes, key=lambda each: not each.is_default)]


def _recipe(cell: Cell, recipe: Recipe) -> Row:
    return {
        "name": recipe.name,
        "about": recipe.about,
        "default": recipe.is_default,
        "form": recipe.form(),
        "example": example(cell, recipe).text,
        "parameters": [_parameter(cell, each) for each in recipe.parameters],
    }


def _parameter(cell: Cell, parameter: Parameter) -> Row:
    called = parameter.called() if parameter.called else OWN(text=parameter.name)
    return {"name": parameter.name, "called": called, **_can_be(cell, parameter)}


def _can_be(cell: Cell, parameter: Parameter) -> Row:
    """Its type, and what that allows: the words of a choice, the limits of a number."""
    limits = parameter.limits(cell)
    if limits is None:
        return {"type": "choice", "choices": list(parameter.words(cell))}
    kind = "integer" if limits.whole else "number"
    return {"type": kind, "lower": limits.lower, "upper": limits.upper, "choices": []}
