"""What a recipe of one's own is written with."""

from .authoring import Choice, Kit, RecipeError, parallel, recipe, work

__all__ = ["Choice", "Kit", "RecipeError", "parallel", "recipe", "work"]
