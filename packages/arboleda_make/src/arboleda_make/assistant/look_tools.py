"""Tools that look at a plant as it is, and the stop."""

from __future__ import annotations

from . import looks
from .desk import LOOK, STOP, Call, Desk, Reply, Tools


class LookTools:
    """LookTools: the plant, its devices, and what its cells can do."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk

    def tools(self) -> Tools:
        """All of them, with their hints."""
        found = self.plant, self.devices, self.recipes, self.nodes, self.targets, self.tree
        return [*((each, LOOK) for each in found), (self.stop, STOP)]

    async def plant(self, call: Call) -> Reply:
        """The cells: state, task, step, queue, what holds them, what leads out; zones; acts of operators."""
        return await self._desk.look(call, looks.plant)

    async def devices(self, call: Call) -> Reply:
        """The devices: their links, positions, facts, latches and open questions to people."""
        return await self._desk.look(call, looks.devices)

    async def recipes(self, call: Call) -> Reply:
        """The recipes of each cell, their parameters, and the values that these can have."""
        return await self._desk.look(call, looks.recipes)

    async def nodes(self, call: Call, cell: str) -> Reply:
        """The nodes that a tree can have in a cell, and the trees that are recipes, as XML."""
        return await self._desk.look(call, lambda plant: looks.nodes(plant, cell))

    async def targets(self, call: Call, cell: str) -> Reply:
        """The targets of a cell, by robot, and its devices with their kinds."""
        return await self._desk.look(call, lambda plant: looks.targets(plant, cell))

    async def tree(self, call: Call, cell: str) -> Reply:
        """The behavior tree that runs in a cell now, as rows and as a picture (SVG)."""
        return await self._desk.look(call, lambda plant: looks.tree(plant, cell))

    async def stop(self, call: Call, scope: str = "") -> Reply:
        """Stop (software) the plant, or a cell or robot: halt and latch. Only a person takes that off."""
        return await self._desk.always(call, lambda plant: plant.stop(scope))
