"""Recipes of one's own: `@recipe` makes one of a function, `@node` and `@function` make
nodes for trees that are written as XML.
"""

from arboleda.model.errors import TextError
from arboleda.model.recipe import Parameter, Recipe
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.task import Order

from .authoring import Kit, WrittenRecipe, parallel, recipe, work
from .errors import RecipeError
from .handles import Pick, Place, Step
from .nodes import WrittenNode, function, node
from .parameters import Choice, Number, Path, Slot, Target

__all__ = [
    "Choice",
    "Kit",
    "Number",
    "Order",
    "Parameter",
    "Path",
    "Phrase",
    "Pick",
    "Place",
    "Recipe",
    "RecipeError",
    "Sentence",
    "Slot",
    "Step",
    "Target",
    "TextError",
    "WrittenNode",
    "WrittenRecipe",
    "function",
    "node",
    "parallel",
    "recipe",
    "work",
]
