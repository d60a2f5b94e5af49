"""The driver `dobot`: its two ports around its machine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from arboleda.drivers import Clock, Hear, Robot, driver
from arboleda_drivers.connections.tcp_ports import TcpPorts
from arboleda_drivers.dobot.dashboard import SendLine
from arboleda_drivers.dobot.machine import DashboardReply, FeedbackData, Machine
from arboleda_drivers.dobot.settings import Settings


@driver("dobot", settings=Settings)
class Dobot(TcpPorts):
    """Driver of one arm of Dobot's CR series."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        super().__init__(
            lambda devices: Machine(devices, self._settings),
            host=settings.host,
            ports={
                settings.port: lambda data: DashboardReply(data=data),
                settings.feedback_port: lambda data: FeedbackData(data=data),
            },
        )

    def listen(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        """The same as `start`, without asking for control, which others may have."""
        self._settings = replace(self._settings, request_control=False)
        self.start(devices, hear, clock)

    def data_of(self, message: Any) -> tuple[int, bytes] | None:
        is_line = isinstance(message, SendLine)
        return (self._settings.port, message.text.encode("ascii")) if is_line else None
