"""How far ROS 2 is heard."""

from __future__ import annotations

import pytest

limit_discovery = pytest.importorskip("arboleda_ros.link", reason="rclpy is not installed").limit_discovery


def test_discovery_stays_on_this_machine_unless_the_user_says_otherwise() -> None:
    fresh: dict[str, str] = {}
    assert "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST" in limit_discovery(fresh, lan=False)
    assert fresh == {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    humble = {"ROS_DISTRO": "humble"}
    assert limit_discovery(humble, lan=False) and humble["ROS_LOCALHOST_ONLY"] == "1"
    chosen = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}
    assert limit_discovery(chosen, lan=False) is None and len(chosen) == 1
    assert limit_discovery({}, lan=True) is None
