"""Lines that lose and delay messages, judged by the simulator."""

from __future__ import annotations

import pytest
from tests.lengths import sample
from tests.probes import Probes

from arboleda.testing import shipped
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.run import Simulation
from arboleda_proofs.simulator.shrink import explicit


@pytest.mark.long
@pytest.mark.parametrize("seed", sample([1, 2, 3], every=2))
def test_what_a_cut_connection_has_kept_moves_nothing_when_it_is_mended(seed: int) -> None:
    cut = Fault(kind="partition", at=5.0, seconds=8.0, target="ra_1", word="down, held")
    simulation = Simulation(shipped("sis_a"), seed, explicit((cut,)))
    probes = Probes(simulation.world)
    result = simulation.run(seconds=60.0)
    assert result.broken is None, str(result.broken)
    assert probes.fired["board: tarde"] > 0, "commands came after it"
    assert result.outcomes["done"] > 0, "and the cell goes on"
