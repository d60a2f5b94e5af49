"""The driver `follow_joint_trajectory` where its messages are missing; the contract has the rest."""

from __future__ import annotations

import sys
import time

import pytest

from arboleda.drivers import DriverError
from arboleda.drivers.joint_trajectory.settings import Settings
from arboleda.testing.plants import shipped
from arboleda_ros.joint_trajectory import FollowJointTrajectory


def test_a_missing_message_package_is_named_in_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "control_msgs", None)
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    driver = FollowJointTrajectory(Settings())
    with pytest.raises(
        DriverError, match=r"needs the message package control_msgs.*apt install ros-jazzy-control-msgs"
    ):
        driver.start([shipped("sis_c").cells[0].arm], lambda report: None, time.monotonic)
    driver.stop()
