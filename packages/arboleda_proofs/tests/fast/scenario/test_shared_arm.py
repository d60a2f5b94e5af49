"""Two cells that share an arm, its gripper and a person hold under faults of each level, and without any."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.lengths import length

from arboleda.plant_file.loader import load
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.run import Simulation

PLANT = Path(__file__).parent / "shared_arm" / "plant.yaml"
SEEDS, CYCLES = length(1, 40), length(3, 6)
LEVELS = length(("many", "crashes"), ("none", "normal", "many", "crashes"))
RUNS = [(level, seed) for level in LEVELS for seed in range(1, SEEDS + 1)]


@pytest.mark.long
@pytest.mark.parametrize(("level", "seed"), RUNS)
def test_nothing_is_broken(level: str, seed: int) -> None:
    plant = load(PLANT)
    result = Simulation(plant, seed, Climate.draw(plant, seed, level).faults).run(cycles=CYCLES)
    assert result.broken is None
    assert result.cycles >= 1
