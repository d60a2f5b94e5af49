"""Drawn plants of devices hold where they are ended in order, with tasks waiting, and started anew."""

from __future__ import annotations

import pytest
from tests.lengths import sample

from arboleda.model.messages import Shutdown
from arboleda.rig.world import World
from arboleda_drawn.plants import of_devices
from arboleda_proofs.simulator.run import Simulation

ENDS_AT_S = (7.0, 31.0, 66.0)
LOOK_S = 0.1


class Endings:
    """Ctrl-C of a simulated plant at some times: it rests, is gone, starts anew; `waiting`: tasks then."""

    def __init__(self, world: World) -> None:
        self.waiting: list[int] = []
        self._world = world
        for at in ENDS_AT_S:
            world.at(world.now + at, self._end, None)

    def _end(self, _: None) -> None:
        self._world.tell(Shutdown(at=self._world.now))
        self._world.at(self._world.now + LOOK_S, self._look, None)

    def _look(self, _: None) -> None:
        plant = self._world.plant
        if plant.intake.closed and plant.at_rest:
            self.waiting.append(sum(len(cell.queue) for cell in plant.cells.values()))
            self._world.crash()
        else:
            self._world.at(self._world.now + LOOK_S, self._look, None)


@pytest.mark.long
@pytest.mark.parametrize("seed", sample(range(10_000, 10_014), 7))
def test_nothing_is_broken_by_orderly_ends(seed: int) -> None:
    simulation = Simulation(of_devices(seed).model, seed, lambda minute: ())
    endings = Endings(simulation.world)
    result = simulation.run(seconds=ENDS_AT_S[-1] + 34.0)
    assert result.broken is None
    assert len(endings.waiting) == len(ENDS_AT_S) and all(endings.waiting)
