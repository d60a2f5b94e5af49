"""The command `arboleda tree`: a recipe's tree as its cell would run it, or as it runs."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from arboleda.engine import Plant
from arboleda.host.packages import extra
from arboleda.model import text
from arboleda.model.errors import ArboledaError
from arboleda.model.packages import TREES
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.model.sentence import Phrase
from arboleda.model.task import Order
from arboleda.plant_file import loader
from arboleda.plant_file.recipe_forms import is_tree_file
from arboleda.views import tree_view

from .client import PlantClient
from .draw import Format, draw
from .language import allowed, say
from .plant_options import PlantFile, StateFolder, StoreAddress, TokensFile, client
from .working import working

Drawn = Annotated[
    Format, typer.Option("--format", help="How to draw it; svg and png need no Graphviz, xml is for editors.")
]
Live = Annotated[bool, typer.Option("--live", help="The tree that runs now, with its statuses.")]
NO_PNG = Phrase("cli.tree.no_png", "a PNG is not for a terminal; add > {recipe}.png")
XML_ALREADY = Phrase("cli.tree.xml_already", "{recipe} is XML already")
NO_CELL = Phrase("cli.tree.no_cell", "'{name}' is not a cell; {others}")
NO_RECIPE = Phrase("cli.tree.no_recipe", "'{recipe}' is not a recipe of {cell}; {others}")
NONE_IN = Phrase("cli.tree.none_in", "No {recipe} runs in {cell} now")
NONE_ANYWHERE = Phrase("cli.tree.none_anywhere", "No {recipe} runs in any cell now")
OTHERS_RUN = Phrase("cli.tree.others_run", "{none}; {others}.")
NONE_RUNS = Phrase("cli.tree.none_runs", "{none}.")
RUNS = Phrase("cli.tree.runs", "{cell} runs {recipe}")


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(tree)


def tree(
    recipe: Annotated[
        str,
        typer.Argument(
            metavar="RECIPE",
            help="The recipe to draw: storage, palletizing; or a task of it, 'sis_a 0B 7'; or a file of "
            "trees, tend.xml.",
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
        raise typer.BadParameter(say(NO_PNG(recipe=recipe)), param_hint="--format")
    if is_tree_file(Path(recipe)) and not live and format is Format.XML:
        raise typer.BadParameter(say(XML_ALREADY(recipe=recipe)), param_hint="--format")
    with working():
        drawn = draw(
            _rows_of(recipe, cell, plant, client(plant, state, store, tokens) if live else None),
            format,
            statuses=live,
        )
    sys.stdout.buffer.write(drawn)
    sys.stdout.flush()


def _rows_of(
    recipe: str, cell: str | None, plant: Path | None, reached: PlantClient | None
) -> list[dict[str, Any]]:
    """The tree that runs in the plant that is reached, if one is; else that of a file or a recipe."""
    if reached is not None:
        return _running(recipe, cell, reached)
    if is_tree_file(Path(recipe)):
        rows: list[dict[str, Any]] = extra("rows", TREES, recipe)(Path(recipe))
        return rows
    return _planned(recipe, cell, loader.load(plant))


def _planned(recipe: str, cell: str | None, model: PlantModel) -> list[dict[str, Any]]:
    """The tree of a task, or of an example of the tasks of a recipe."""
    if " " in recipe.strip():
        return _rows(model, text.parse(recipe, model))
    names = [each.name for each in model.cells]
    name = _cell(cell, [each.name for each in model.cells if cell is None and _offers(each, recipe)] or names)
    where = model.cell(name)
    if not _offers(where, recipe):
        others = allowed(recipe, [each.name for each in where.recipes])
        raise typer.BadParameter(say(NO_RECIPE(recipe=recipe, cell=name, others=others)))
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
    trees: dict[str, list[dict[str, Any]]] = {
        each["name"]: each["tree"] for each in cells if each["tree"] and cell in (None, each["name"])
    }
    found = next((rows for rows in trees.values() if rows[0]["name"] == recipe), None)
    if found is None:
        none = NONE_ANYWHERE(recipe=recipe) if cell is None else NONE_IN(recipe=recipe, cell=cell)
        others = tuple(RUNS(cell=name, recipe=str(rows[0]["name"])) for name, rows in trees.items())
        raise ArboledaError(OTHERS_RUN(none=none, others=others) if others else NONE_RUNS(none=none))
    return found


def _cell(name: str | None, names: list[str]) -> str:
    if name is not None and name not in names:
        raise typer.BadParameter(say(NO_CELL(name=name, others=allowed(name, names))), param_hint="--cell")
    return name or names[0]
