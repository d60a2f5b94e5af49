"""Zones of mobile robots, judged by the simulator."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.scenario.test_advice_for_zones import LONELY, THERE_AND_BACK

from arboleda.plant_file.loader import load
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.run import Simulation
from arboleda_proofs.simulator.shrink import explicit

PLANT = """
name: cross
uses: [recipes.py]
cells:
  yard:
    devices: {one: {kind: mobile}, two: {kind: mobile}}
    targets:
      home: {one: {node: 6}, two: {node: 8}}
      gate: {one: {node: 3}, two: {node: 3}}
      far: {one: {node: 0}}
zones:
  gate: {poses: [yard gate]}
"""


RECIPES = """
from arboleda.recipes import parallel, recipe, work

@recipe("go")
def go(cell):
    one, two = cell.devices("one", "two")
    return parallel(work(one.go("far"), one.home()), two.visit("gate", cell.wait(3)))
"""


@pytest.mark.sampled(2)
@pytest.mark.parametrize("seed", [1, 2])
def test_it_waits_for_the_zone_of_a_node_on_its_way(tmp_path: Path, seed: int) -> None:
    (tmp_path / "plant.yaml").write_text(PLANT, "utf-8")
    (tmp_path / "recipes.py").write_text(RECIPES, "utf-8")
    model = load(tmp_path / "plant.yaml")
    result = Simulation(model, seed, explicit(())).run(seconds=60.0)
    assert result.broken is None, str(result.broken)
    assert result.outcomes.keys() == {"done"}


def test_its_zone_is_kept_while_its_last_node_may_be_from_before_its_stop(tmp_path: Path) -> None:
    """It is stopped on its way into the zone, and its nodes come later than its state."""
    (tmp_path / "plant.yaml").write_text(LONELY, "utf-8")
    (tmp_path / "recipes.py").write_text(THERE_AND_BACK, "utf-8")
    stop = Fault(kind="operator_stop", at=5.0, target="one")
    result = Simulation(load(tmp_path / "plant.yaml"), 28, explicit((stop,))).run(seconds=12.0)
    assert result.broken is None, str(result.broken)
    assert result.outcomes["stopped"] == 1
