"""Virtual PLC over OPC UA, which serves the belt's program."""

from __future__ import annotations

import time

from arboleda.drivers import DriverError
from arboleda.extension import StartError
from arboleda_drivers.opcua.adapter import need_library
from arboleda_drivers.opcua.server import OpcUaServer
from arboleda_drivers.virtual.faults import Faults

from .program import BeltProgram


class Server:
    """Server of the belt, which listens from `start` to `stop`."""

    def __init__(self, faults: Faults, *, host: str = "127.0.0.1", port: int = 0) -> None:
        self._host = host
        self._server = OpcUaServer(BeltProgram(faults, time.monotonic), host=host, port=port)
        self.port = 0

    @property
    def says(self) -> str:
        return f"the virtual PLC speaks OPC UA on opc.tcp://{self._host}:{self.port}"

    def start(self) -> None:
        """Listen; raises StartError if asyncua is missing, or the port cannot be opened."""
        try:
            need_library()
            self.port = self._server.start()
        except (OSError, DriverError) as error:
            raise StartError(str(error)) from error

    def stop(self) -> None:
        self._server.stop()
