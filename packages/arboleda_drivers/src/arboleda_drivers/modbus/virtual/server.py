"""Virtual PLC over Modbus, which serves the belt's memory."""

from __future__ import annotations

import time

from arboleda.drivers import DriverError
from arboleda.extension import StartError
from arboleda_drivers.modbus.adapter import need_library
from arboleda_drivers.modbus.server import ModbusServer
from arboleda_drivers.virtual.faults import Faults

from .memory import BeltMemory


class Server:
    """Server of the belt, which listens from `start` to `stop`."""

    def __init__(self, faults: Faults, *, host: str = "127.0.0.1", port: int = 0, serial: str = "") -> None:
        self._where = serial or host
        memory = BeltMemory(faults, time.monotonic, tcp=not serial)
        self._server = ModbusServer(memory, host=host, port=port, serial=serial, trace=memory.trace)
        self.port = 0

    @property
    def says(self) -> str:
        where = f"{self._where}:{self.port}" if self.port else self._where
        return f"the virtual PLC speaks Modbus on {where}"

    def start(self) -> None:
        """Listen; raises StartError if pymodbus is missing, or the port cannot be opened."""
        try:
            need_library()
            self.port = self._server.start()
        except (OSError, DriverError) as error:
            raise StartError(str(error)) from error

    def stop(self) -> None:
        self._server.stop()
