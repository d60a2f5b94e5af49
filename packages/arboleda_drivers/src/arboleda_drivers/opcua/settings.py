"""Settings of a device behind OPC UA in a plant file: its keys, checked against the device."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from arboleda.drivers import Robot

from .checks import problems
from .keys import OpcUaKeys


@dataclass(frozen=True, kw_only=True)
class Settings(OpcUaKeys):
    """Settings of the driver `opcua`: the connection, and the mapping of one device.

    Passwords are in the environment, under the prefix `secrets`.
    """

    def problems(self, device: Robot) -> Iterator[tuple[tuple[str | int, ...], str]]:
        """Settings that do not fit a device, each as its keys and a sentence."""
        return problems(self, device)
