"""A device that answers over MQTT 5 on the topic that each order names, at a mosquitto."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.contract.conftest import Mosquitto
from tests.packages import ROOT

from arboleda.drivers import DriverError
from arboleda.plant_file.loader import load
from arboleda_drivers.mqtt_mapping.virtual.server import Server

pytestmark = pytest.mark.system
EXAMPLE = ROOT / "examples/own_topics"
ASKS = '            ask: [{topic: "cmnd/{device}/POWER"}] # empty, it is a question\n'
KEYS = """            version: "5"
            done: {hear: "{reply}", path: POWER}
            broker: "%s"
"""


def test_an_answer_that_names_the_order_ends_it(
    mosquitto: Callable[..., Mosquitto], tmp_path: Path, arboleda: Callable[..., Any]
) -> None:
    broker, plant = mosquitto(), tmp_path / "tasmota.yaml"
    broker.start()
    text = (EXAMPLE / "tasmota.yaml").read_text("utf-8")
    text = text.replace(ASKS, KEYS % broker.address).replace('"{to}",', '"{to}", reply: true,')
    text = text.replace("effect: switch", "effect: process, on_stop: finish")
    plant.write_text(text, "utf-8")
    (tmp_path / "recipes.py").write_text((EXAMPLE / "recipes.py").read_text("utf-8"), "utf-8")
    model = load(plant)
    assert model.robots["lamp"].evidence.value == "ids"
    with pytest.raises(DriverError, match="and a device speaks MQTT 5"):
        Server([*model.robots.values()], ())
    played = Server([*model.robots.values()], (), is_there=True)
    played.start()
    try:
        up = arboleda("up", "--once", "room light on", "--plant", str(plant), "--boards", "real")
        up.wait_for("done      room on")
        assert up.wait() == 0, up.output
    finally:
        played.stop()
