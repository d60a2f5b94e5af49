"""The command `arboleda tree`: a recipe's tree as its cell would run it, or as it runs."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from arboleda.bt_xml import rows as tree_rows
from arboleda.core import text
from arboleda.core.plant import Plant
from arboleda.model.errors import ArboledaError, ConfigError
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.model.task import Order
from arboleda.plant_file import loader, tree_file
from arboleda.views import tree_view

from .client import PlantClient
from .draw import Format, draw
from .plant_options import PlantFile, StateFolder, StoreAddress, TokensFile, client

Drawn = Annotated[
    Format, typer.Option("--format", help="How to draw it; svg and png need no Graphviz, xml is for editors.")
]
Live = Annotated[bool, typer.Option("--live", help="The tree that runs now, with its statuses.")]


def tree(
    recipe: Annotated[
        str,
        typer.Argument(
            help="The recipe to draw: storage, palletizing; or a task of it, 'sis_a 0B 7'; or a file of "
            "trees, tend.xml."
        ),
    ],
    plant: PlantFile = None,
    cell: Annotated[str | None, typer.Option(help="Whose tree. [default: the first cell]")] = None,
    format: Drawn = Format.ASCII,
    live: Live = False,
    state: StateFolder = None,
    store: StoreAddress = "",
    tokens: TokensFile = None,
) -> None:
    """Draw the behavior tree of a recipe, or the one that runs.

    A picture of it: `arboleda tree storage --format svg > storage.svg`.
    """
    if format is Format.PNG and sys.stdout.isatty():
        raise typer.BadParameter(f"a PNG is not for a terminal; add > {recipe}.png", param_hint="--format")
    if tree_file.is_tree_file(Path(recipe)) and not live:
        if format is Format.XML:
            raise typer.BadParameter(f"{recipe} is XML already", param_hint="--format")
        rows = _of_file(Path(recipe))
    else:
        reached = client(plant, state, store, tokens) if live else None
        rows = _running(recipe, cell, reached) if reached else _planned(recipe, cell, loader.load(plant))
    sys.stdout.buffer.write(draw(rows, format, statuses=live))
    sys.stdout.flush()


def _of_file(path: Path) -> list[dict[str, Any]]:
    """The tree that a file of trees names as its main one, or its only one."""
    forest = tree_file.load(path).forest
    if forest.main is None:
        there = ", ".join(forest.trees) or "none"
        raise ConfigError((f'{path}: which tree? <root main_tree_to_execute="...">; there are {there}',))
    return tree_rows.rows(forest, forest.main)


def _planned(recipe: str, cell: str | None, model: PlantModel) -> list[dict[str, Any]]:
    """The tree of a task, or of an example of the tasks of a recipe."""
    if " " in recipe.strip():
        return _rows(model, text.parse(recipe, model))
    names = [each.name for each in model.cells]
    name = _cell(cell, [each.name for each in model.cells if cell is None and _offers(each, recipe)] or names)
    where = model.cell(name)
    if not _offers(where, recipe):
        there = ", ".join(each.name for each in where.recipes)
        raise typer.BadParameter(f"'{recipe}' is not a recipe of {name}; there are {there}")
    return _rows(model, text.example(where, where.recipe(recipe)))


def _rows(model: PlantModel, order: Order) -> list[dict[str, Any]]:
    plant = Plant(model, epoch=0, now=0.0)
    cell = plant.cells[order.cell]
    tree = cell.cell.recipe(order.recipe).build(order, cell.context)
    return tree_view.rows(tree, plant.now)


def _offers(cell: Cell, recipe: str) -> bool:
    return any(each.name == recipe for each in cell.recipes)


def _running(recipe: str, cell: str | None, reached: PlantClient) -> list[dict[str, Any]]:
    """The tree of this recipe that runs in the cell, else in the first cell that runs one."""
    cells = reached.status()["cells"]
    if cell is not None:
        _cell(cell, [each["name"] for each in cells])
    trees = {each["name"]: each["tree"] for each in cells if each["tree"] and cell in (None, each["name"])}
    found = next((rows for rows in trees.values() if rows[0]["name"] == recipe), None)
    if found is None:
        others = ", ".join(f"{name} runs {rows[0]['name']}" for name, rows in trees.items())
        raise ArboledaError(f"No {recipe} runs in {cell or 'any cell'} now{others and f'; {others}'}.")
    return found


def _cell(name: str | None, names: list[str]) -> str:
    if name is not None and name not in names:
        raise typer.BadParameter(f"'{name}' is not a cell; there are {', '.join(names)}", param_hint="--cell")
    return name or names[0]
