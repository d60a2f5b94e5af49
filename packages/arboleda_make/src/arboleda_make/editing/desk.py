"""Everything that an editor of trees asks about the cells of a plant, as plain data of `client/answers/`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from arboleda.drivers import among, quoted
from arboleda.engine import Plant
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.recipes.of_files import FileRecipe
from arboleda_trees.bt_xml import leaves
from arboleda_trees.bt_xml.recipe import own_nodes

from . import copy_recipe
from .apply import apply
from .errors import EditError
from .marks import marks
from .operations import Operation
from .palette import palette as groups
from .picture import picture
from .tree_text import TreeText

Row = dict[str, Any]


def tree_files(model: PlantModel) -> list[Row]:
    """The files of trees that are recipes, as they were read: a TreeFile each."""
    return [
        {
            "recipe": each.name,
            "file": each.file.rpartition("/")[2],
            "cells": [cell.name for cell in model.cells if each in cell.recipes],
            "text": each.content.decode(),
        }
        for each in model.recipes
        if isinstance(each, FileRecipe)
    ]


def palette(model: PlantModel, cell: str, words: Mapping[str, str]) -> list[Row]:
    """The nodes that a tree can have in a cell, as `palette.palette` groups them."""
    return groups(_cell(model, cell), own_nodes(model.recipes).values(), words)


def drawn(model: PlantModel, cell: str, text: str, operation: Operation | None = None) -> Row:
    """A file after an operation on it: Drawn; raises EditError."""
    kinds = leaves.of_cell(_cell(model, cell), own_nodes(model.recipes).values())
    after = text if operation is None else apply(text, operation)
    there = TreeText(after)
    return {"text": after, "trees": picture(there, kinds), "marks": marks(there, kinds)}


def copied(model: PlantModel, cell: str, recipe: str, name: str) -> str:
    """A recipe in Python as the file of a tree `name`; raises EditError for one that no tree can express."""
    where = _cell(model, cell)
    return copy_recipe.tree(model, Plant(model, epoch=0, now=0.0).cells[where.name].context, recipe, name)


def _cell(model: PlantModel, name: str) -> Cell:
    names = [each.name for each in model.cells]
    if name not in names:
        raise EditError(f"{quoted(name)} is not a cell of this plant; {among(name, names)}")
    return model.cells[names.index(name)]
