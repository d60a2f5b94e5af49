"""The command `arboleda tree`: a recipe's tree as its cell would run it, or as it runs."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from arboleda.core import recipes, tree_view
from arboleda.core.errors import ArboledaError
from arboleda.core.model import PlantModel
from arboleda.core.plant import Plant
from arboleda.core.task import Order, Recipe

from . import config
from .draw import Format, draw
from .where import PlantFile, StateFolder, client

Drawn = Annotated[Format, typer.Option("--format", help="How to draw it; svg and png need no Graphviz.")]
Live = Annotated[bool, typer.Option("--live", help="The tree that runs now, with its statuses.")]


def tree(
    recipe: Annotated[Recipe, typer.Argument(help="The recipe to draw.")],
    plant: PlantFile = None,
    cell: Annotated[str | None, typer.Option(help="Whose tree. [default: the first cell]")] = None,
    format: Drawn = Format.ASCII,
    live: Live = False,
    state: StateFolder = None,
) -> None:
    """Draw the behavior tree of a recipe, e.g. `arboleda tree storage --format svg > storage.svg`."""
    if format is Format.PNG and sys.stdout.isatty():
        raise typer.BadParameter(
            f"a PNG is not for a terminal; add > {recipe.value}.png", param_hint="--format"
        )
    rows = _running(recipe, cell, plant, state) if live else _planned(recipe, cell, config.load(plant))
    sys.stdout.buffer.write(draw(rows, format, statuses=live))
    sys.stdout.flush()


def _planned(recipe: Recipe, cell: str | None, model: PlantModel) -> list[dict[str, Any]]:
    """The tree of a task with the first path and the last station."""
    name = _cell(cell, [each.name for each in model.cells])
    where = model.cell(name)
    order = Order(
        text=recipe.value, cell=name, recipe=recipe, path=where.paths[0], station=where.stations[-1]
    )
    plant = Plant(model, epoch=0, now=0.0)
    return tree_view.rows(recipes.build(order, plant.cells[name].context), plant.now)


def _running(
    recipe: Recipe, cell: str | None, plant: Path | None, state: Path | None
) -> list[dict[str, Any]]:
    """The tree of this recipe that runs in the cell, else in the first cell that runs one."""
    cells = client(plant, state).status()["cells"]
    if cell is not None:
        _cell(cell, [each["name"] for each in cells])
    trees = {each["name"]: each["tree"] for each in cells if each["tree"] and cell in (None, each["name"])}
    found = next((rows for rows in trees.values() if rows[0]["name"] == recipe.value), None)
    if found is None:
        others = ", ".join(f"{name} runs {rows[0]['name']}" for name, rows in trees.items())
        raise ArboledaError(f"No {recipe.value} runs in {cell or 'any cell'} now{others and f'; {others}'}.")
    return found


def _cell(name: str | None, names: list[str]) -> str:
    if name is not None and name not in names:
        raise typer.BadParameter(f"'{name}' is not a cell; there are {', '.join(names)}", param_hint="--cell")
    return name or names[0]
