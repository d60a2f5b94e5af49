"""The example of several makers with those behind ROS 2: five controllers and a plant with one command."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from .test_mixed import copied

pytestmark = [pytest.mark.system, pytest.mark.requires("pymodbus")]


def test_a_part_is_shipped_by_one_command(
    tmp_path: Path, start: Callable[..., Any], ros_domain: int, quick_discovery: None
) -> None:
    copied(tmp_path)
    state = ("--state", str(tmp_path / "state"))
    plant = start(sys.executable, str(tmp_path / "start.py"), "--ros2", "line ship slot_1 400", *state)
    plant.wait_for("done      line ship slot_1 400", patience_s=110)
    assert plant.interrupt() == 0, plant.output
    assert "Traceback" not in plant.output
