"""Tools that try the plant file that the server was started with, and draw its cells."""

from __future__ import annotations

from .bench import Bench
from .desk import LOOK, Call, Desk, Reply, Tools
from .floor import Floor


class FileTools:
    """FileTools: `check`, `simulate` and `prove` of the file, and the cells of its plant from above."""

    def __init__(self, desk: Desk, bench: Bench) -> None:
        self._desk = desk
        self._bench = bench
        self._floor = Floor(bench.file)

    def tools(self) -> Tools:
        """All of them, with their hints."""
        return [(each, LOOK) for each in (self.check, self.simulate, self.prove, self.twin)]

    async def check(self, call: Call) -> Reply:
        """Findings of the plant file and of all that it uses, with file, line and what is allowed; `mend` has
        edits after which they are gone, where some are known: they were tried. It may take two minutes."""
        return await self._desk.look(call, lambda _: self._bench.check())

    async def simulate(self, call: Call, seeds: int = 5, cycles: int = 4) -> Reply:
        """Run the plant file on virtual devices with faults, 1 to 50 seeds; says what broke, and how."""
        return await self._desk.look(call, lambda _: self._bench.simulate(seeds, cycles))

    async def prove(self, call: Call, recipes: list[str] | None = None, budget_s: int = 30) -> Reply:
        """Try every single fault at every kind of moment of these recipes (none: of all), for 1 to 300 s:
        what breaks, what nobody would notice, and in `mend` edits that mend it, where some were found."""
        return await self._desk.look(call, lambda _: self._bench.prove(recipes or [], budget_s))

    async def twin(self, call: Call, cell: str) -> Reply:
        """The devices of a cell from above, where the plant believes them to be, as a picture (SVG)."""
        return await self._desk.look(call, lambda plant: self._floor.picture(plant, cell))
