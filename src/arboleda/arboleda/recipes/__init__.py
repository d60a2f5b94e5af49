"""What recipes of one's own are written with; `@recipe` makes one of a function."""

from .authoring import Kit, WrittenRecipe, parallel, recipe, work
from .errors import RecipeError
from .parameters import Choice, Number, Target

__all__ = ["Choice", "Kit", "Number", "RecipeError", "Target", "WrittenRecipe", "parallel", "recipe", "work"]
