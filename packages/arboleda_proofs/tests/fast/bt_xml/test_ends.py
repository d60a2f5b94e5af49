"""Ends that a tree as XML declares, judged by the simulator."""

from __future__ import annotations

from pathlib import Path

import pytest
from packages.arboleda_trees.tests.fast.bt_xml.test_ends import plant

from arboleda_proofs.simulator.run import Simulation


@pytest.mark.long
@pytest.mark.parametrize(("end", "broken"), [("nest: 1", None), ("nest: 0", "recipes_end_as_they_say")])
def test_the_simulator_judges_the_end(tmp_path: Path, end: str, broken: str | None) -> None:
    found = Simulation(plant(tmp_path, end), 1, lambda minute: []).run(cycles=1)
    assert (found.broken and found.broken.invariant) == broken
