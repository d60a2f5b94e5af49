"""A release on an operator's word obeys the needs of the verb that lets go, of a stopped device, too."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda_proofs.testing import Sim

PLANT = """
name: vises
uses: [recipes.py]
kinds:
  vise:
    facts: {clamped: bool, guard: [open, closed]}
    verbs:
      clamp: {effect: switch, with: {on: bool}, sets: {clamped: $on}, needs: {guard: open}, holds: part}
      shut: {effect: motion, sets: {guard: closed}}
      mill: {effect: process, takes_s: 5}
cells:
  bench:
    devices: {vise: {kind: vise}}
"""
RECIPES = """
from arboleda.recipes import recipe, work

@recipe("grip")
def grip(cell):
    vise = cell.device("vise")
    return work(vise.clamp(on=True), vise.shut(), vise.mill())
"""


@pytest.fixture
def shut(sim: Sim, tmp_path: Path) -> Sim:
    """The plant while it works on a part in its vise, behind the closed guard."""
    (tmp_path / "plant.yaml").write_text(PLANT)
    (tmp_path / "recipes.py").write_text(RECIPES)
    sim.plant(tmp_path / "plant.yaml")
    sim.submit("bench grip")
    sim.run(until=lambda: sim.cell("bench").step == "vise mill")
    return sim


def test_a_stopped_device_does_not_let_go_while_a_need_is_not_met(shut: Sim) -> None:
    shut.operate("stop", "vise")
    shut.run(1)
    assert shut.operate("release", "vise") is not None
    shut.run(2)
    assert shut.robot("vise").facts == {"clamped": True, "guard": "closed"}
