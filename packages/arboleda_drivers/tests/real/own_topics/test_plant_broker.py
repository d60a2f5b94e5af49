"""A device that is mapped by its topics and names no broker, at the one that the plant is told."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import pytest
from tests.packages import ROOT

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.drivers import Device
from arboleda.plant_file.loader import load
from arboleda_drivers.mqtt_mapping.settings import Settings
from arboleda_drivers.mqtt_mapping.virtual.server import Server

pytestmark = pytest.mark.system
PLANT = ROOT / "examples/own_topics/tasmota.yaml"


@pytest.fixture
def broker() -> Iterator[str]:
    """The address of a broker with a lamp, which is not where the plant looks without being told."""
    broker = EmbeddedBroker("127.0.0.1", 0)
    at = str(broker.start())
    lamp = load(PLANT).robots["lamp"]
    assert isinstance(lamp, Device) and lamp.driver is not None
    assert isinstance(lamp.driver.settings, Settings)
    there = replace(lamp.driver, settings=replace(lamp.driver.settings, broker=at))
    played = Server([replace(lamp, driver=there)], (), is_there=True)
    played.start()
    yield at
    played.stop()
    broker.stop()


def test_a_lamp_is_reached_at_the_broker_that_up_is_told(broker: str, arboleda: Callable[..., Any]) -> None:
    words = ("--once", "room light on", "--plant", str(PLANT), "--boards", "real")
    up = arboleda("up", *words, "--broker", broker)
    up.wait_for("done      room on")
    assert up.wait() == 0, up.output
