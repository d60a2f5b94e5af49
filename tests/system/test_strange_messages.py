"""A message that a kind of robot cannot mean costs nobody anything, in the real chain."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from arboleda.adapters.broker_login import address
from arboleda.adapters.mqtt import MqttClient
from arboleda.model.plant_model import Evidence
from arboleda.wire.transport import Publication

from .conftest import Chain

pytestmark = [pytest.mark.system, pytest.mark.requires("rclpy", "mosquitto")]
BAD = b'{"nodo":6,"estado":0,"seq":4000000000,"arranque":1,"efector":0}'


def test_a_mobile_that_names_an_effector_ends_nothing(
    chain: Callable[..., Chain], request: pytest.FixtureRequest
) -> None:
    from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

    parts = chain(Evidence.IDS)
    parts.wait_until_ready("ra3", "rm_sis_c")
    joined: list[Any] = []
    stranger = MqttClient("stranger", address(parts.address), subscriptions=[], on_event=joined.append)
    stranger.start()
    request.addfinalizer(stranger.close)
    parts.observer.wait(lambda: joined, "the stranger did not reach the broker")
    stranger.publish(Publication(topic="rm_sis_c/sensores", payload=BAD))
    status = parts.observer.publisher(DiagnosticStatus, "/rm_sis_c/status")
    said = [KeyValue(key=key, value=value) for key, value in (("state", "0"), ("effector", "true"))]
    status.publish(DiagnosticStatus(level=b"\0", name="arboleda: rm_sis_c", values=said))
    parts.plant.wait_for("rm_sis_c: more than one node publishes on /rm_sis_c/status")
    parts.observer.node.destroy_publisher(status)
    parts.submit("sis_c 0A 4")
    assert parts.outcome("sis_c 0A 4")["state"] == "done"
