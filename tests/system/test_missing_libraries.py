"""The ROS 2 nodes where a library is missing: one sentence, or a part that is left out."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from .conftest import paths

pytestmark = [pytest.mark.system, pytest.mark.requires("rclpy")]

START = """
import sys
sys.modules[{library!r}] = None
sys.argv[1:] = ["--ros-args", *{parameters!r}]
from arboleda_ros import nodes
sys.exit(nodes.main({node!r}))
"""


def program(node: str, library: str, *parameters: str) -> tuple[str, ...]:
    """The executable on a machine that has no such library."""
    words = [word for parameter in parameters for word in ("-p", parameter)]
    return (sys.executable, "-c", START.format(library=library, node=node, parameters=words))


@pytest.mark.usefixtures("ros_domain")
def test_without_its_library_the_dashboard_is_off_and_the_plant_runs(
    start: Callable[..., Any], tmp_path: Path
) -> None:
    parameters = ("dashboard:=true", f"state_dir:={tmp_path}")
    plant = start(*program("orchestrator", "fastapi", *parameters), env={"PYTHONPATH": paths()})
    plant.wait_for("MQTT broker: ")
    off = [line for line in plant.lines if "the dashboard is off: " in line]
    assert len(off) == 1 and "pip install 'fastapi'" in off[0]
    assert "HTTP API" not in plant.output
    assert plant.interrupt() == 0, plant.output
