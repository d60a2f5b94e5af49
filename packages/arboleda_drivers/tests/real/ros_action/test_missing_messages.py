"""Drivers of actions where their messages are missing; the contract of drivers has the rest."""

from __future__ import annotations

import sys
import time
from typing import Any

import pytest

from arboleda.drivers import DriverError
from arboleda.testing.plants import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda_drivers.joint_trajectory.adapter import FollowJointTrajectory
from arboleda_drivers.joint_trajectory.settings import Settings as ArmSettings
from arboleda_drivers.nav2.adapter import NavigateToPose
from arboleda_drivers.nav2.settings import ToPose

CELL = shipped("sis_c").cells[0]


@pytest.mark.parametrize(
    ("driver", "device", "package"),
    [
        (FollowJointTrajectory(ArmSettings()), StorageLayout(CELL).arm, "control_msgs"),
        (NavigateToPose(ToPose()), StorageLayout(CELL).mobile, "nav2_msgs"),
    ],
)
def test_a_missing_message_package_is_named_in_one_sentence(
    driver: Any, device: Any, package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    apt = f"ros-jazzy-{package.replace('_', '-')}"
    with pytest.raises(DriverError, match=rf"needs the message package {package}.*apt install {apt}"):
        driver.start([device], lambda report: None, time.monotonic)
    driver.stop()
