"""The driver `ur`: its three ports around its machine."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

from arboleda.drivers import Clock, Hear, Robot, driver
from arboleda_drivers.connections.tcp_ports import TcpPorts
from arboleda_drivers.ur.machine import Machine
from arboleda_drivers.ur.port_data import DASHBOARD, PRIMARY, RTDE, Received, Send
from arboleda_drivers.ur.settings import Settings


def _event(port: str, data: bytes) -> Received:
    return Received(port=port, data=data)


@driver("ur", settings=Settings)
class Ur(TcpPorts):
    """Driver of one arm of Universal Robots."""

    def __init__(self, settings: Settings) -> None:
        self._numbers = {
            DASHBOARD: settings.port,
            RTDE: settings.rtde_port,
            PRIMARY: settings.script_port,
        }
        self._only_listens = False
        super().__init__(
            lambda devices: Machine(devices, settings, only_listens=self._only_listens),
            host=settings.host,
            ports={number: partial(_event, name) for name, number in self._numbers.items()},
        )

    def listen(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        """The same as `start`, without a heartbeat, whose register others may write."""
        self._only_listens = True
        self.start(devices, hear, clock)

    def data_of(self, message: Any) -> tuple[int, bytes] | None:
        return (self._numbers[message.port], message.data) if isinstance(message, Send) else None
