"""Settings of a device behind a Siemens S7 in a plant file: its keys, checked against the device."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from arboleda.drivers import Robot

from .checks import problems
from .keys import S7Keys


@dataclass(frozen=True, kw_only=True)
class Settings(S7Keys):
    """Settings of the driver `s7`: the connection, and the mapping of one device."""

    def problems(self, device: Robot) -> Iterator[tuple[tuple[str | int, ...], str]]:
        """Settings that do not fit a device, each as its keys and a sentence."""
        return problems(self, device)
