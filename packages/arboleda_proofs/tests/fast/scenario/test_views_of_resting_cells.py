"""The parts of a view that are remembered are, after every step of a simulated plant, as if made anew."""

from __future__ import annotations

from itertools import product
from typing import Any

import pytest
from tests.lengths import length

from arboleda.core.plant import Plant
from arboleda.rig.world import World
from arboleda.views import view
from arboleda.views.resting_cells import RestingCells
from arboleda_drawn.plants import DrawnPlants
from arboleda_proofs.campaigns.request import Request
from arboleda_proofs.simulator.run import Simulation

CYCLES = 1
FEW = [(8, True), (3, False)]  # in which cells rest that share nothing
SEEDS = length(FEW[:1], list(dict.fromkeys([*FEW, *product(range(1, 60), (False, True))])))


class Onlooker:
    """Looks after every step at both views, one that remembers and one made anew."""

    def __init__(self, world: World) -> None:
        self.remembered = 0
        self._world = world
        self._plant: Plant | None = None
        self._cells: list[dict[str, Any]] = []
        world.watchers.append(self._look)

    def _look(self) -> None:
        plant = self._world.plant
        if plant is not self._plant:
            self._plant, self._resting = plant, RestingCells()
        shown = view.snapshot(plant, self._resting.part)
        assert shown == view.snapshot(plant)
        before, self._cells = self._cells, shown["cells"]
        self.remembered += sum(a is b for a, b in zip(before, self._cells, strict=False))


@pytest.mark.long
@pytest.mark.parametrize(("seed", "drawn"), SEEDS)
def test_after_every_step_what_is_remembered_is_as_if_made_anew(seed: int, drawn: bool) -> None:
    setting = Request(cycles=CYCLES, source=DrawnPlants() if drawn else None).setting
    simulation = Simulation(setting.plant(seed), seed, setting.climate(seed).faults, invariants=())
    onlooker = Onlooker(simulation.world)
    assert simulation.run(cycles=CYCLES).broken is None
    assert onlooker.remembered > 0 or (seed, drawn) not in FEW
