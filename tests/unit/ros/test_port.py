"""Handlers of a port: none of them, and no message, ends the executor."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable
from typing import Any
from unittest import mock

import pytest

pytest.importorskip("rclpy", reason="rclpy is not installed")

from std_msgs.msg import UInt32

from arboleda.model.errors import PayloadError
from arboleda.model.plant_model import PlantModel
from arboleda.wire import epochs
from arboleda_ros import qos
from arboleda_ros.bridge import BridgePort
from arboleda_ros.orchestrator import OrchestratorPort
from arboleda_ros.port import Port


def node() -> mock.MagicMock:
    """A node of no middleware, which keeps what it was asked to make."""
    made = mock.MagicMock()
    made.get_name.return_value = "ear"
    made.get_namespace.return_value = "/"
    made.get_fully_qualified_name.return_value = "/ear"
    made.context.get_domain_id.return_value = 7
    made.resolve_topic_name.side_effect = lambda topic: f"/{topic}"
    return made


class Ear(Port):
    """A port that listens to one topic."""

    def __init__(self, middleware: Any, handle: Callable[[UInt32], None]) -> None:
        super().__init__(middleware, lambda: 0.0)
        self.topics.listen(UInt32, "beat", handle, qos.COMMAND)


def test_a_handler_that_raises_is_logged_and_the_next_message_is_handled(
    caplog: pytest.LogCaptureFixture,
) -> None:
    heard: list[int] = []

    def fragile(message: UInt32) -> None:
        if message.data == 13:
            raise RuntimeError("boom")
        if message.data == 99:
            raise PayloadError("99 means nothing")
        heard.append(message.data)

    middleware = node()
    port = Ear(middleware, fragile)
    hear = middleware.create_subscription.call_args.args[2]
    for number in (13, 99, 14):
        hear(UInt32(data=number))
    assert heard == [14]
    health = port.health()
    assert (health.failures, health.refused) == (1, 1)
    assert "the handler of /beat failed" in caplog.text
    assert "refused a message on /beat: 99 means nothing" in caplog.text


def test_a_bridge_counts_a_plant_that_can_never_be_and_says_once_that_one_is_far_ahead(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("time.time", lambda: 1_800_000_000.0)
    now, heard, middleware = [0.0], [], node()
    port = BridgePort(middleware, PlantModel(name="bare", cells=()), heard.append, lambda: now[0])
    hear = middleware.create_subscription.call_args.args[2]
    for now[0] in (0.0, 1.0, 60.0):
        for number in (2_116_000_000, 2_117_000_000, epochs.HORIZON + 1):
            hear(UInt32(data=number))
    assert [event.message.epoch for event in heard] == [2_116_000_000, 2_117_000_000] * 3
    assert port.health().refused == 3
    assert f"a heartbeat of plant {epochs.HORIZON + 1} is refused" in caplog.text
    for number in (2_116_000_000, 2_117_000_000):
        assert caplog.text.count(f"plant {number} is far ahead of the clock here (1800000000)") == 1


def test_types_of_others_that_are_not_installed_are_one_line(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "py_trees_ros_interfaces", None)
    monkeypatch.delitem(sys.modules, "arboleda_ros.snapshot_streams", raising=False)
    with caplog.at_level(logging.INFO, "arboleda.ros"):
        OrchestratorPort(node(), PlantModel(name="bare", cells=()), [].append, lambda: 0.0)
    said = [record.message for record in caplog.records if "py_trees" in record.message]
    assert said == ["py_trees_ros_interfaces is not installed here: no trees for py-trees-tree-watcher"]
