"""One seed from its first step to rest."""

from __future__ import annotations

import pytest

from arboleda.testing import shipped
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.run import Simulation

FREEZE = Fault(kind="plant_freeze", at=20.0, seconds=3.0, target="plant", word="plant", amount=50_000.0)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("seconds", [45.0, 90.0])
def test_a_run_for_so_many_seconds_does_not_count_a_day_in_which_nobody_did_anything(seconds: float) -> None:
    simulation = Simulation(shipped("sis_a"), 1, lambda minute: [] if minute else [FREEZE], invariants=[])
    ends: list[float] = []
    simulation.watched.come_to_rest = lambda: ends.append(simulation.watched.seconds)  # type: ignore[method-assign]
    result = simulation.run(seconds=seconds)
    assert simulation.world.skipped_s == 50_000.0
    assert ends == [pytest.approx(seconds)]
    assert result.faults == [FREEZE]
