"""Invariants of storage and of devices hold over all starts of a plant."""

from __future__ import annotations

import pytest
from tests.lengths import length, sample

from arboleda.testing import shipped
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.faults import KINDS, OF_CRASHES
from arboleda_proofs.simulator.run import Simulation

from .test_general_invariants import load, shop

WEATHER = {**dict.fromkeys(OF_CRASHES, 8.0), "double_submit": 6.0}
HERE = {"storage": shipped(), "devices": shop(load)}


@pytest.mark.long
@pytest.mark.parametrize("kind", HERE)
@pytest.mark.parametrize("seed", sample([1, 2], every=2))
def test_all_of_them_hold_however_often_the_plant_dies(kind: str, seed: int) -> None:
    model = HERE[kind]
    rates = {name: rate for name, rate in WEATHER.items() if KINDS[name].targets(model)}
    climate = Climate.from_file(model, seed, {"rates": rates})
    assert Simulation(model, seed, climate.faults).run(cycles=length(2, whole=6)).broken is None
