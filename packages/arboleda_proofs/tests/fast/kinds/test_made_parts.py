"""Parts that devices make, judged by the simulator."""

from __future__ import annotations

from pathlib import Path

from tests.plants import read
from tests.unit.kinds.test_made_parts import PLANT, PRINT
from tests.unit.kinds.test_places import recipe_of

from arboleda_proofs.simulator.invariants.part_places import PLACES
from arboleda_proofs.simulator.run import Simulation


def test_the_simulator_judges_what_is_made(tmp_path: Path) -> None:
    result = Simulation(read(tmp_path, PLANT, recipe_of(PRINT)), 1, lambda minute: [], invariants=PLACES).run(
        cycles=2
    )
    assert result.broken is None and result.outcomes == {"done": result.cycles}
