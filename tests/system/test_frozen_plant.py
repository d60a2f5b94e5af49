"""A process that is stopped and goes on: nothing moves before an operator says so."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable
from typing import Any

import pytest

from arboleda.model.plant_model import Evidence

from ..patience import PATIENCE_S
from .conftest import Chain

pytestmark = [pytest.mark.system, pytest.mark.requires("rclpy", "mosquitto")]
FROZEN_S = 4.0  # boards stop after 1 s, and a robot's silence may last 1.5 s
LOOK_S = 5.0


def freeze(parts: Chain, process: Any) -> None:
    """SIGSTOP, some seconds, SIGCONT."""
    os.kill(process.pid, signal.SIGSTOP)
    until = time.monotonic() + FROZEN_S
    parts.observer.wait(lambda: time.monotonic() > until, "never", FROZEN_S + PATIENCE_S)
    os.kill(process.pid, signal.SIGCONT)


def test_a_plant_that_was_stopped_in_a_move_holds_its_cell(chain: Callable[..., Chain]) -> None:
    from std_msgs.msg import Float32MultiArray

    parts = chain(Evidence.IDS)
    goals = [f"/{name}" for name in ("ra1/joint_goals_q", "rm_sis_a/path_cmd")]
    parts.observer.listen(Float32MultiArray, *goals)
    for text in ("sis_a 0B 4", "sis_a 0B 5"):
        parts.submit(text)
    parts.wait_for_step("sis_a", "move to pick-up")
    freeze(parts, parts.plant)
    parts.wait_for_cell("sis_a", lambda cell: cell["state"] == "held")
    assert "the plant was away for" in parts.cell("sis_a")["held_by"]
    for topic in goals:
        del parts.observer.heard[topic][:]
    until = time.monotonic() + LOOK_S
    parts.observer.wait(lambda: time.monotonic() > until, "never", LOOK_S + PATIENCE_S)
    assert [parts.observer.heard[topic] for topic in goals] == [[], []]
    assert parts.cell("sis_a")["state"] == "held"
