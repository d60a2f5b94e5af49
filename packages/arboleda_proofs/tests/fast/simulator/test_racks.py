"""The judge of places: the stations of a rack."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.plant_file.loader import load
from arboleda_proofs.simulator.invariants.part_places import PLACES
from arboleda_proofs.simulator.judged_world import JudgedWorld

NEAR, FAR = "deg: [52.388, 52.853], mm: 27.371", "deg: [40, 53], mm: 27"
RACK = f"""
name: rack
paths: {{AZ: [7]}}
cells:
  lab:
    arm: {{name: arm, model: scara, link: mqtt, evidence: ids}}
    mobile: {{name: cart, model: mobile, link: mqtt, evidence: ids}}
    home: {{deg: [0, 0], mm: 0}}
    pickup: {{deg: [52.397, 52.786], mm: 27.352}}
    stations:
      '0': {{{NEAR}}}
      '1': {{deg: [140.5, 74.5], mm: 75}}
"""


@pytest.mark.parametrize(
    ("station", "is_doubtful"), [(NEAR, True), (FAR, False)], ids=["one place", "two places"]
)
def test_nobody_knows_what_is_taken_where_a_station_and_the_pickup_are_one_place(
    tmp_path: Path, station: str, is_doubtful: bool
) -> None:
    (tmp_path / "plant.yaml").write_text(RACK.replace(NEAR, station), "utf-8")
    watched = JudgedWorld(load(tmp_path / "plant.yaml"), invariants=PLACES)
    world = watched.world
    for order in ("lab AZ 0", "lab AZ 1"):
        world.request_task(order)
        world.advance(20.0)
    assert [task.state.value for task in world.plant.intake.tasks.values()] == ["done", "done"]
    assert world.plant.cells["lab"].context.places.counts == {"station_0": 1, "station_1": 1}
    assert watched.truth.places.cells["lab"].is_doubtful is is_doubtful
