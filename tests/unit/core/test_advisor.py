"""What is advised of an idle cell."""

from __future__ import annotations

from arboleda.model.messages import Verb
from arboleda.testing.plants import shared
from arboleda.testing.storage_layout import StorageLayout

from .conftest import Hand


def test_an_arm_that_is_seen_at_no_pose_of_a_cell_with_zones_is_to_be_homed() -> None:
    model = shared()
    cell = next(cell for cell in model.cells if StorageLayout(cell).space.zones)
    layout = StorageLayout(cell)
    plant, arm = Hand(model), layout.arm.name
    plant.awake(**{arm: tuple(value + 0.05 for value in layout.home.q)})
    assert [(each.do, each.scope) for each in plant.plant.advice(cell.name)] == [(Verb.HOME, arm)]
    plant.awake()
    assert plant.plant.advice(cell.name) == ()
