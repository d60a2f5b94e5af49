"""What recipes of one's own are written with: `@recipe` makes one of a function, `@node` and `@function` make
nodes for trees that are written as XML.
"""

from .authoring import Kit, WrittenRecipe, parallel, recipe, work
from .errors import RecipeError
from .nodes import WrittenNode, function, node
from .parameters import Choice, Number, Target

__all__ = [
    "Choice",
    "Kit",
    "Number",
    "RecipeError",
    "Target",
    "WrittenNode",
    "WrittenRecipe",
    "function",
    "node",
    "parallel",
    "recipe",
    "work",
]
