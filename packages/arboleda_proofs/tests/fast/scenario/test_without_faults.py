"""Without faults no task fails, at every level of evidence, pose order and speed."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import pytest
from tests.cells import with_palletizing, with_poses
from tests.lengths import sample

from arboleda.model.plant_model import Evidence, PlantModel
from arboleda.testing import shipped, slowed
from arboleda.testing.storage_layout import StorageLayout
from arboleda_proofs.simulator.run import Simulation

SEEDS = (1, 2, 3, 4)  # robots say where they are and that they move together, apart, or of two instants
CYCLES = 3


def plant(evidence: Evidence, place: str, slower: float) -> PlantModel:
    """One cell whose palletizing puts the part at its home pose, where it picked it up, or somewhere else."""
    model = slowed(shipped("sis_a", evidence=evidence, assume_homed=evidence is not Evidence.IDS), slower)
    (cell,) = model.cells
    cell = with_poses(cell, station_0=replace(cell.stations[0], q=StorageLayout(cell).home.q))
    return replace(model, cells=(with_palletizing(cell, "pickup", PLACES[place]),))


PLACES = {"at home": "station_0", "at the pick-up": "pickup", "elsewhere": "station_8"}
CASES = product(Evidence, PLACES, (1.0, 4.0), SEEDS)


@pytest.mark.sampled(5)
@pytest.mark.parametrize(("evidence", "place", "slower", "seed"), sample(CASES, every=17))
def test_no_task_fails(evidence: Evidence, place: str, slower: float, seed: int) -> None:
    result = Simulation(plant(evidence, place, slower), seed, lambda minute: []).run(cycles=CYCLES)
    assert result.broken is None
    assert result.checks["no_task_fails_without_a_fault"] and result.outcomes["done"]
