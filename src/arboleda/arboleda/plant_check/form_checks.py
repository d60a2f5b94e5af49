"""Checks of the nodes of recipes that are no Python, by the suffix of their files.

A package registers an object that keeps to `FormCheck` under the entry point group `arboleda.checks`,
with the suffix as its name, without the dot. It is loaded for a plant that has a recipe of such a file.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import PurePath
from typing import Protocol

from py_trees.behaviour import Behaviour

from arboleda.host.packages import entry_points
from arboleda.model.plant_model import PlantModel
from arboleda.recipes.of_files import FileRecipe

from .walkthrough import Rule

GROUP = "arboleda.checks"


class FormCheck(Protocol):
    """Check of the recipes of one form: the rule of a walkthrough for each class of nodes, and warnings."""

    rules: Mapping[type[Behaviour], Rule]

    def warnings(self, plant: PlantModel) -> tuple[str, ...]: ...


def of_plant(plant: PlantModel) -> list[FormCheck]:
    """The checks of the forms that the recipes of a plant have."""
    recipes = [each for cell in plant.cells for each in cell.recipes if isinstance(each, FileRecipe)]
    suffixes = {PurePath(each.file).suffix for each in recipes}
    return [each.load() for each in entry_points(GROUP) if f".{each.name}" in suffixes]


def warnings(plant: PlantModel) -> tuple[str, ...]:
    """The warnings of all these checks."""
    return tuple(sentence for check in of_plant(plant) for sentence in check.warnings(plant))
