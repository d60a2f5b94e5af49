"""The types that the health of an arm needs."""

from __future__ import annotations

import pytest

from arboleda.drivers.port import DriverError
from arboleda_drivers.ros_action.health import Health
from arboleda_drivers.ros_action.health_link import HealthLink


@pytest.mark.requires("rclpy")
def test_a_type_that_is_not_installed_is_told_with_what_to_install() -> None:
    unknown = Health(topic="t", type="ur_dashboard_msgs/msg/SafetyMode", field="mode", well=(1,))
    with pytest.raises(DriverError, match="install ur_dashboard_msgs") as told:
        HealthLink(None, unknown, lambda message, event: None)
    assert "ur_dashboard_msgs/msg/SafetyMode" in str(told.value)
