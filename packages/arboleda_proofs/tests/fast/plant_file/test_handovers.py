"""Handovers of the plant file, judged by the simulator."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.plants import read
from tests.unit.plant_file.test_handovers import LONG

from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.run import Simulation


@pytest.mark.long
@pytest.mark.parametrize("more", ["", "      ana: {kind: person}\n"], ids=["alone", "with a person"])
def test_such_a_cell_is_judged_right(tmp_path: Path, more: str) -> None:
    model = read(tmp_path, LONG.replace("    targets:\n", f"{more}    targets:\n"))
    result = Simulation(model, 3, Climate.draw(model, 3, "normal").faults).run(cycles=4)
    assert result.broken is None, str(result.broken)
    assert result.outcomes["done"]


@pytest.mark.long
def test_pick_ups_at_one_point_are_judged_right(tmp_path: Path) -> None:
    model = read(tmp_path, LONG.replace("pickup_a: {arm: {deg: [50, 10]", "pickup_a: {arm: {deg: [45, 10]"))
    targets = model.cells[0].reach["ra"].targets
    assert targets["pickup"].q == targets["pickup_a"].q
    result = Simulation(model, 1, Climate.draw(model, 1, "none").faults).run(cycles=1)
    assert result.broken is None, str(result.broken)
