"""The driver `gcode`: machines of axes with GRBL, Marlin or Klipper, on a serial line or at a TCP port."""

from __future__ import annotations

import os
from collections.abc import Sequence

from arboleda.drivers import Robot, driver
from arboleda_drivers.connections.controller_machine import ControllerMachine
from arboleda_drivers.connections.stream_driver import Stream, StreamDriver
from arboleda_drivers.gcode.dialects import machine
from arboleda_drivers.gcode.settings import Settings

KEY = "ARBOLEDA_MOONRAKER_KEY"
"""The variable of the environment with Moonraker's key, which is never in a plant file."""


@driver("gcode", settings=Settings)
class Gcode(StreamDriver):
    """Driver of one machine of axes."""

    def __init__(self, settings: Settings) -> None:
        super().__init__(settings)
        self._settings = settings

    def machine(self, devices: Sequence[Robot]) -> ControllerMachine:
        return machine(devices, self._settings)

    def open(self) -> Stream:
        if self._settings.dialect != "moonraker":
            return super().open()
        from arboleda_drivers.connections.web_socket import (
            WebSocketStream,  # it takes a while to load, and only Moonraker needs it
        )

        key = os.environ.get(KEY, "")
        headers = {"X-Api-Key": key} if key else {}
        return WebSocketStream(self._settings.host, self._settings.port, "/websocket", headers)
