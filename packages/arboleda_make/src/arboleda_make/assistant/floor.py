"""Floor of a cell: its devices from above, drawn where the plant believes them to be."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

from arboleda.client import AsyncPlant, Robot
from arboleda.drivers import shown
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader
from arboleda_proofs.campaigns.from_above import FloorPlan, Scene, as_svg

from .looks import NothingThere, one


class Floor:
    """Floor: reads the plant file once, without running its Python, and draws its cells."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._model: PlantModel | None = None

    async def picture(self, reached: AsyncPlant, cell: str) -> dict[str, Any]:
        """The devices of a cell: a picture, and as words what each of them reports."""
        robots = (await reached.snapshot()).robots
        if self._model is None:
            self._model = await asyncio.to_thread(loader.load, self._file, recipes=False)
        return drawn(self._model, cell, robots)


def drawn(model: PlantModel, cell: str, robots: list[Robot]) -> dict[str, Any]:
    """The picture of these devices; NothingThere for another cell, and where nothing of it can be drawn."""
    one({each.name: each for each in model.cells}, cell)
    plan = FloorPlan(model, cell)
    names = {each.name for each in model.cell(cell).robots}
    here = [each for each in robots if each.name in names]
    lines = {each.name: plan.line(each.name, node=each.node, q=each.q) for each in here if each.name in plan}
    svg = as_svg(Scene(lines=lines, grids=plan.grids, targets=plan.targets))
    if not svg:
        raise NothingThere("Nothing of this cell can be drawn: no robot of it has a place that is known.")
    return {"svg": svg, "facts": {each.name: _facts(each) for each in here}}


def _facts(robot: Robot) -> str:
    """The facts that a device has reported, as words."""
    known = {fact: value for fact, value in robot.facts.items() if value is not None}
    return ", ".join(f"{fact}: {shown(value)}" for fact, value in known.items())
