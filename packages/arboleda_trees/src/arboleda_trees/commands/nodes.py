"""The command `arboleda nodes`: what a tree can be made of in a plant, for people and for editors."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

import typer

from arboleda.cli.language import allowed
from arboleda.cli.plant_options import CellName
from arboleda.cli.tree import NO_CELL
from arboleda.extension import PlantFile, say
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader
from arboleda_trees.bt_xml import leaves, writing
from arboleda_trees.bt_xml.nodes import Kind, PortDirection
from arboleda_trees.bt_xml.recipe import own_nodes


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(nodes)


def nodes(
    plant: PlantFile = None,
    cell: CellName = None,
    as_xml: Annotated[
        bool, typer.Option("--xml", help="Print a TreeNodesModel, which editors of trees read.")
    ] = False,
) -> None:
    """List what a tree can tell the devices of a plant, and ask them, with values.

    An editor such as Groot2 draws with it: `arboleda nodes --xml > plant_nodes.xml`. `arboleda check tend.xml
    --plant FILE` checks a tree against it.
    """
    known = of_plant(loader.load(plant), cell)
    if as_xml:
        print(writing.document([writing.models(known.values())]), end="")
        return
    for kind in known.values():
        print(_line(kind))


def of_plant(model: PlantModel, cell: str | None) -> Mapping[str, Kind]:
    """The kinds of nodes of a plant, or of one of its cells, by name; those in Python with them."""
    names = [each.name for each in model.cells]
    if cell is not None and cell not in names:
        raise typer.BadParameter(say(NO_CELL(name=cell, others=allowed(cell, names))), param_hint="--cell")
    chosen = [each for each in model.cells if cell in (None, each.name)]
    return leaves.of_cells(chosen, own_nodes(model.recipes).values())


def _line(kind: Kind) -> str:
    ports = (kind.ports or {}).values()
    facts = [
        f"{'gives ' * (port.direction is PortDirection.OUT)}{port.name} ({_what(port.words, port.about)})"
        for port in ports
    ]
    about = [f"  {kind.about}"] if kind.about else []
    return "\n".join([f"{kind.category.value} {kind.name}{': ' if facts else ''}{'; '.join(facts)}", *about])


def _what(words: tuple[str, ...], about: str) -> str:
    return ", ".join(words) or about
