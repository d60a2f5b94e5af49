"""Check of recipes in Python: steps that get a name and stand nowhere, whatever the parameters are."""

from __future__ import annotations

from arboleda.model.plant_model import PlantModel
from arboleda.recipes.authoring import WrittenRecipe


def warnings(plant: PlantModel) -> tuple[str, ...]:
    """A sentence for each such step, with its place; it was noted when the recipe was tried."""
    recipes = [recipe for cell in plant.cells for recipe in cell.recipes]
    unused = [each for recipe in recipes if isinstance(recipe, WrittenRecipe) for each in recipe.unused]
    return tuple(dict.fromkeys(unused))
