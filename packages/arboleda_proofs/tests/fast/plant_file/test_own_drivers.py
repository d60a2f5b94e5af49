"""A plant with drivers of its own is simulated on virtual boards."""

from __future__ import annotations

from collections.abc import Callable

from tests.unit.plant_file.test_own_drivers import load as load
from tests.unit.plant_file.test_own_drivers import oven

from arboleda.model.plant_model import Link, PlantModel
from arboleda_proofs.campaigns.plants import Plant


def test_a_plant_with_drivers_is_simulated_on_virtual_boards(load: Callable[..., PlantModel]) -> None:
    simulated = oven(Plant(declared=load()).model)
    assert simulated.link is Link.MQTT and simulated.driver is None
