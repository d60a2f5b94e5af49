"""Types of ROS 2 by their names, `std_srvs/srv/Trigger`, imported where they are asked for, and topics."""

from __future__ import annotations

import os
from collections.abc import Callable
from importlib import import_module
from typing import Any

from arboleda.drivers import DriverError


def interface(name: str) -> Any:
    """The type of that name; raises DriverError with install advice where it is missing."""
    package, kind, type = name.split("/")
    try:
        return getattr(import_module(f"{package}.{kind}"), type)
    except ImportError as error:
        why = f"the message package {package}, which cannot be imported here ({error})"
    except AttributeError:
        why = f"{name}, which the message package {package} here does not have"
    distro = os.environ.get("ROS_DISTRO", "$ROS_DISTRO")
    apt = f"ros-{distro}-{package.replace('_', '-')}"
    raise DriverError(f"it needs {why}: sudo apt install {apt}, and source that ROS 2")


def hear_all(node: Any, type: Any, topic: str, take: Callable[[Any], object]) -> None:
    """Subscribe to a topic, whatever the quality of service of its publishers."""
    from arboleda_ros.qos import SENSOR, VIEW

    # One hears any publisher, the other the last value of those that keep it.
    for profile in (SENSOR, VIEW):
        node.create_subscription(type, topic, take, profile)
