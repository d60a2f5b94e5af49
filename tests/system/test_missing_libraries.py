"""The ROS 2 nodes where a library is missing: one sentence, or a part that is left out."""

from __future__ import annotations

import os
import subprocess
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


@pytest.mark.parametrize(
    ("node", "library", "cure"),
    [
        ("mqtt_bridge", "paho", "pip install 'paho-mqtt>=2'"),
        ("mqtt_bridge", "paho.mqtt.enums", "pip install 'paho-mqtt>=2'"),
        ("mqtt_bridge", "yaml", "pip install 'PyYAML'"),
        ("virtual_devices", "pydantic", "pip install 'pydantic>=2'"),
        ("orchestrator", "py_trees", "pip install 'py_trees'"),
        ("orchestrator", "diagnostic_msgs", "source a ROS 2 installation"),
    ],
)
def test_a_node_names_what_to_install(node: str, library: str, cure: str) -> None:
    env = {**os.environ, "PYTHONPATH": paths()}
    ended = subprocess.run(program(node, library), env=env, capture_output=True, text=True, check=False)
    assert ended.returncode == 1
    assert ended.stderr.startswith(f"{node}: the Python library ") and cure in ended.stderr
    assert ended.stderr.count("\n") == 1, ended.stderr


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
