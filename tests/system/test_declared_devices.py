"""Devices of declared kinds in the parts that `arboleda up` starts: a real broker, and ROS 2."""

from __future__ import annotations

import queue
from pathlib import Path

import pytest

from arboleda.model.messages import TaskChanged, TaskState
from arboleda.runtime.build import App, Options, build

from ..patience import PATIENCE_S
from ..unit.kinds.lab import model

pytestmark = pytest.mark.system

RATE = 10.0
PARTS = ("broker", "devices", "bridge", "orchestrator")


def outcome(app: App, text: str) -> TaskChanged:
    """The end of a task of a plant that is started for it."""
    ends: queue.Queue[TaskChanged] = queue.Queue()
    under_way = (TaskState.QUEUED, TaskState.RUNNING)
    app.listen(lambda change: None if change.state in under_way else ends.put(change))
    app.start()
    try:
        app.plant.submit(text)
        return ends.get(timeout=PATIENCE_S)
    finally:
        app.stop()


def test_a_bench_of_declared_devices_works_over_ros_and_mqtt(tmp_path: Path, ros_domain: int) -> None:
    pytest.importorskip("rclpy", reason="rclpy is not installed")
    from arboleda_ros.link import connect

    app = build(model(), PARTS, Options(state_dir=tmp_path, rate=RATE, link=connect()))
    assert outcome(app, "bench bake 10").state is TaskState.DONE
