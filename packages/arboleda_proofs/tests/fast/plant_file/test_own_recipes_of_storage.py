"""Recipes of storage in files beside the plant file, judged by the simulator."""

from __future__ import annotations

import pytest
from tests.unit.plant_file.test_own_recipes_of_storage import own

from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.run import Simulation


@pytest.mark.long
def test_simulations_of_them_hold() -> None:
    result = Simulation(own(), 3, Climate.draw(own(), 3, "normal").faults).run(cycles=6)
    assert result.broken is None
    assert result.outcomes.get("done", 0) > 0
