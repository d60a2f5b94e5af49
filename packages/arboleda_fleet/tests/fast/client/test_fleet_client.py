"""Methods that this package adds to the client of a plant, against its routes and a plant in this process."""

from __future__ import annotations

import pytest
from tests.client_methods import differences, left, methods_of, routes_of_package
from tests.guarded_plant import guarded
from tests.in_process import ORIGIN, Machine
from tests.in_process import machine as machine
from tests.web_plant import Plant
from tests.web_plant import plant as plant

from arboleda.client import Plant as Client
from arboleda_fleet.client import Fleet
from arboleda_fleet.oee.api import OeeApi

ROUTES = routes_of_package("fleet")
METHODS = methods_of(Fleet)


@pytest.fixture
def client(machine: Machine, plant: Plant) -> Client:
    plant.offered[OeeApi] = plant
    machine.listen(8080, guarded(plant).app)
    return Client(ORIGIN, patience_s=0.0)


def test_every_route_has_a_method_that_takes_and_returns_the_same() -> None:
    assert left(ROUTES, METHODS) == set()
    assert differences(ROUTES, METHODS) == []


def test_figures_come_as_they_are_declared(client: Client) -> None:
    assert client.oee(cell="sis_a") == Fleet(client).oee(cell="sis_a")
    assert client.oee(cell="sis_a")[0].failed == 1
