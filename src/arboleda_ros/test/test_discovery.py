"""The package as installed joins ROS 2, and keeps to this machine."""

from __future__ import annotations

import pytest

pytest.importorskip("rclpy")

from arboleda_ros.link import limit_discovery


def test_unless_the_user_chose_nodes_are_seen_on_this_machine_only() -> None:
    environ = {"ROS_DISTRO": "jazzy"}
    limit_discovery(environ, lan=False)
    assert environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"
