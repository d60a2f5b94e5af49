"""Recipes of one's own: `@recipe` makes one of a function, `@node` and `@function` make
nodes for trees that are written as XML.
"""

from .authoring import Kit, WrittenRecipe, parallel, recipe, work
from .errors import RecipeError
from .handles import Pick, Place
from .nodes import WrittenNode, function, node
from .parameters import Choice, Number, Path, Slot, Target

__all__ = [
    "Choice",
    "Kit",
    "Number",
    "Path",
    "Pick",
    "Place",
    "RecipeError",
    "Slot",
    "Target",
    "WrittenNode",
    "WrittenRecipe",
    "function",
    "node",
    "parallel",
    "recipe",
    "work",
]
