"""The executables where something is missing: one sentence that says what to install."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from arboleda_ros.nodes import NAMES

START = """
import sys
sys.modules[{library!r}] = None
from arboleda_ros import nodes
sys.exit(nodes.main({node!r}))
"""


def start(node: str, library: str) -> subprocess.CompletedProcess[str]:
    """The executable on a machine that has no such library."""
    program = START.format(library=library, node=node)
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    return subprocess.run(
        [sys.executable, "-c", program], env=env, capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize("node", NAMES)
def test_without_ros_a_node_says_where_it_comes_from(node: str) -> None:
    ended = start(node, "rclpy")
    assert ended.returncode == 1
    assert ended.stderr.startswith(f"{node}: the Python library rclpy cannot be used here (")
    assert "source a ROS 2 installation" in ended.stderr
    assert ended.stderr.count("\n") == 1, ended.stderr
