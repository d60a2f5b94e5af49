"""Looks of an assistant at a plant: plain data out of the answers of the client."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from arboleda.client import AsyncPlant, Cell
from arboleda.drawing.picture import picture
from arboleda.drawing.svg import svg
from arboleda.drivers import among, quoted
from arboleda.extension import ArboledaError
from arboleda_make.client import AsyncMake

Row = dict[str, Any]


class NothingThere(ArboledaError):
    """There is no such thing in the plant; the sentence says what there is."""


async def plant(reached: AsyncPlant) -> Row:
    """The plant with its cells, without their trees."""
    snapshot = await reached.snapshot()
    cells = [
        {name: value for name, value in asdict(each).items() if name != "tree"} for each in snapshot.cells
    ]
    return {
        "plant": snapshot.plant,
        "ending": snapshot.ending,
        "cells": cells,
        "zones": snapshot.zones,
        "acts": snapshot.acts,
    }


async def devices(reached: AsyncPlant) -> Row:
    return {"devices": (await reached.snapshot()).robots}


async def recipes(reached: AsyncPlant) -> Row:
    return {"offers": await reached.recipes()}


async def nodes(reached: AsyncPlant, cell: str) -> Row:
    made = AsyncMake(reached)
    return {"nodes": await made.palette(cell), "trees": await made.trees()}


async def targets(reached: AsyncPlant, cell: str) -> Row:
    """The targets of a cell as its plant file has them, and its devices with their kinds."""
    found = await AsyncMake(reached).proposal_base()
    return {**one(found.cells, cell), "kinds": found.kinds}


async def tree(reached: AsyncPlant, cell: str) -> Row:
    """The behavior tree that runs in a cell, as rows and as a picture."""
    one = await _cell(reached, cell)
    if not one.tree:
        raise NothingThere(f"No task is at work in {quoted(cell)}, so it has no tree now.")
    return {"rows": one.tree, "svg": svg(picture(one.tree))}


async def _cell(reached: AsyncPlant, cell: str) -> Cell:
    found: Cell = one({each.name: each for each in (await reached.snapshot()).cells}, cell)
    return found


def one(known: Mapping[str, Any], name: str) -> Any:
    """The cell of a name; NothingThere for another one, with those that there are."""
    if name not in known:
        raise NothingThere(f"{quoted(name)} is not a cell; {among(name, known)}")
    return known[name]
