"""The judge knows which hands closed beside a part, and whether the plant could know it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest
from tests.plants import read
from tests.unit.kinds.test_missed_parts import CHECKED, PLANT, RECIPE, UNCHECKED

from arboleda.dispatch.effectors import Effectors
from arboleda_proofs.simulator.faults.kind import Fault
from arboleda_proofs.simulator.run import Result, Simulation
from arboleda_proofs.simulator.shrink import explicit

SUPPLY = PLANT.replace("nest: {}, vise: {}", "nest: {supply: true}, vise: {holds: 100}")


def run(folder: Path, body: str, kind: str, at: Sequence[float], plant: str = SUPPLY) -> Result:
    faults = [Fault(kind=kind, at=each, seconds=20.0, target="mover") for each in at]
    model = read(folder, plant, RECIPE.format(body=body, before=""))
    return Simulation(model, 1, explicit(faults)).run(cycles=6)


@pytest.mark.parametrize("believes", [True, False])
def test_books_have_no_part_where_a_hand_put_none(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, believes: bool
) -> None:
    if not believes:
        monkeypatch.setattr(Effectors, "feel", lambda *_, **__: None)
    result = run(tmp_path, UNCHECKED, "no_grip", [0.0])
    assert (result.broken is None) is believes, str(result.broken)
    assert believes or result.broken.invariant == "books_of_parts_are_true"


@pytest.mark.parametrize("kind", ["no_grip", "no_part", "lost_part"])
@pytest.mark.parametrize("body", [CHECKED, UNCHECKED], ids=["checked", "unchecked"])
def test_a_right_cell_that_misses_its_part_is_held(tmp_path: Path, body: str, kind: str) -> None:
    result = run(tmp_path, body, kind, [3.0, 9.3, 14.1, 30.0, 47.7])
    assert result.broken is None, str(result.broken)
