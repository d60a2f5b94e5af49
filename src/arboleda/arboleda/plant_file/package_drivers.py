"""Drivers of the package `arboleda_drivers`: a plant file that names one is told what to install."""

from __future__ import annotations

from arboleda.model.packages import DRIVERS, MISSING
from arboleda.model.sentence import OWN

OF_ROBOTS = frozenset(
    {"dobot", "follow_joint_trajectory", "follow_waypoints", "gcode", "navigate_to_pose", "serial_arm", "ur"}
)
"""Drivers of arms and mobile robots, which are of no declared kind."""
OF_DEVICES = frozenset({"gripper_command", "modbus", "mqtt", "opcua", "pylabrobot", "ros", "s7", "vda5050"})
ALL = OF_ROBOTS | OF_DEVICES


def not_installed(name: str) -> str:
    """The sentence that the package of a driver is not installed."""
    return str(MISSING(what=OWN(text=f"the driver {name}"), package=DRIVERS))
