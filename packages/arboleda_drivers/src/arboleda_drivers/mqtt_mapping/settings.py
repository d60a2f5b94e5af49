"""Settings of the driver `mqtt`: its keys, held against a device."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from arboleda.drivers import Device, Evidence, Robot
from arboleda_drivers.plc.checks import Problem

from . import checks
from .keys import Keys


@dataclass(frozen=True, kw_only=True)
class Settings(Keys):
    __doc__ = Keys.__doc__

    def evidence_of(self, device: Robot) -> Evidence:
        """Level of evidence that the device's words have."""
        return checks.evidence(self, device) if isinstance(device, Device) else device.evidence

    def problems(self, device: Robot) -> Iterator[Problem]:
        """Keys that do not fit a device, each with a sentence."""
        return checks.problems(self, device)

    def shown(self, device: Robot) -> Iterator[str]:
        """Lines for a person: what is sent, and what is believed."""
        return checks.shown(self, device) if isinstance(device, Device) else iter(())
