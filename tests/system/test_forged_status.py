"""A stranger publishes what a robot reports: no task is done for it, and people are told who it was."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from arboleda.model.plant_model import Evidence

from .conftest import Chain

pytestmark = [pytest.mark.system, pytest.mark.requires("rclpy", "mosquitto")]


def test_a_status_that_ends_the_open_command_ends_no_task(chain: Callable[..., Chain]) -> None:
    from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

    parts = chain(Evidence.IDS)
    parts.submit("sis_a 0B 4")
    parts.wait_for_step("sis_a", "move to pick-up")
    heard: list[DiagnosticStatus] = []
    parts.observer.heard["/ra1/status"] = heard
    parts.observer.node.create_subscription(DiagnosticStatus, "/ra1/status", heard.append, 10)
    parts.observer.wait(lambda: heard, "no status of ra1")
    forge = parts.observer.node.create_publisher(DiagnosticStatus, "/ra1/status", 10)
    said = {pair.key: pair for pair in heard[-1].values}
    forged = DiagnosticStatus(level=b"\0", name=heard[-1].name, hardware_id="ra_1", message="stopped")
    forged.values = [pair for key, pair in said.items() if key not in ("done", "state")]
    forged.values += [KeyValue(key="state", value="0"), KeyValue(key="done", value=said["accepted"].value)]

    outcome: list[Any] = []

    def ended() -> bool:
        forge.publish(forged)
        outcome[:] = [
            message for message in parts.observer.heard["/task_status"] if '"failed"' in message.data
        ]
        return bool(outcome)

    parts.observer.wait(ended, "the task did not fail")
    assert "more than one node publishes on /ra1/status (/mqtt_bridge and " in outcome[0].data
    parts.plant.wait_for("(/mqtt_bridge and /observer)")  # a busy machine knows the name only later
    assert not [message for message in parts.observer.heard["/task_status"] if '"done"' in message.data]
    parts.observer.node.destroy_publisher(forge)
    parts.wait_for_robot("ra1", lambda robot: robot["online"])
