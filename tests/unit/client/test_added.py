"""Methods that packages add to a plant: found where one is used, and named where the package is missing."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
from tests.added_package import install
from tests.guarded_plant import guarded
from tests.in_process import ORIGIN, Machine
from tests.in_process import machine as machine
from tests.packages import leave_out
from tests.web_plant import Plant
from tests.web_plant import plant as plant

from arboleda.client import AsyncPlant, MethodMissing, PlantError
from arboleda.client import Plant as Client
from arboleda.client.added import GROUP

ORDERS = """
from arboleda.client import Routes, Task, route

class Orders(Routes):
    @route("GET", "/api/tasks", list[Task])
    def orders(self):
        'The orders.'

    @route("GET", "/api/plant", str)
    def tasks(self):
        'The runner has this name.'
"""


@pytest.fixture
def orders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    install(tmp_path, "arboleda_orders", ORDERS, group=GROUP, what="Orders")
    monkeypatch.syspath_prepend(tmp_path)


@pytest.fixture
def client(machine: Machine, plant: Plant) -> Client:
    machine.listen(8080, guarded(plant).app)
    return Client(ORIGIN, patience_s=0.0)


def test_a_plant_has_the_methods_of_a_package(orders: None, client: Client) -> None:
    assert client.orders() == client.tasks() and client.orders()[0].id == "t-1"
    assert "orders" in dir(client) and client.orders.__doc__ == "The orders."


def test_in_a_loop_they_are_awaited(orders: None, client: Client) -> None:
    async def work() -> None:
        async with AsyncPlant(ORIGIN, patience_s=0.0) as awaited:
            assert (await awaited.orders())[0].id == "t-1"

    asyncio.run(work())


def test_a_package_that_breaks_is_left_out_and_named_once(
    orders: None, client: Client, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    install(tmp_path, "arboleda_broken", "1 / 0", group=GROUP)
    install(tmp_path, "arboleda_odd", "PARTS = dict", group=GROUP)
    assert client.orders()
    assert client.orders() and not hasattr(client, "other")
    assert caplog.messages == [
        "Arboleda goes on without the client of arboleda_broken 1: ZeroDivisionError: division by zero",
        "Arboleda goes on without the client of arboleda_odd 1: "
        "TypeError: arboleda_odd:PARTS is no class of Routes",
    ]


def test_a_method_of_a_package_that_is_not_installed_says_what_to_install(
    client: Client, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    leave_out(monkeypatch, tmp_path, "arboleda_make")
    with pytest.raises(
        MethodMissing, match=r"^Plant\.draft needs the package make, .*'arboleda\[make\]'$"
    ) as error:
        client.draft()
    assert isinstance(error.value, PlantError) and not hasattr(client, "draft")


def test_what_nobody_adds_is_not_there(client: Client) -> None:
    with pytest.raises(AttributeError, match="'snapshoot'"):
        client.snapshoot()
