"""Virtual S7, which serves the belt's data blocks."""

from __future__ import annotations

import threading
import time

from arboleda.drivers import DriverError
from arboleda.extension import StartError
from arboleda_drivers.s7.adapter import need_library
from arboleda_drivers.s7.server import Memory, S7Server
from arboleda_drivers.virtual.faults import Faults

from .memory import BeltMemory

TICK_S = 0.02


class Server:
    """Server of the belt, which listens from `start` to `stop`."""

    def __init__(self, faults: Faults, *, host: str = "127.0.0.1", port: int = 0) -> None:
        self._host, self._faults, self._port = host, faults, port
        self._ending = threading.Event()
        self._memory = BeltMemory(faults, time.monotonic)
        self._server: S7Server | None = None
        self.port = 0

    @property
    def says(self) -> str:
        return f"the virtual PLC speaks S7 on {self._host}:{self.port}"

    def start(self) -> None:
        """Listen; raises StartError if python-snap7 is missing, or the port cannot be opened."""
        try:
            need_library()
            self._server = S7Server(
                Hushed(self._memory, self._faults, self._ending), host=self._host, port=self._port
            )
            self.port = self._server.start()
        except (OSError, DriverError) as error:
            raise StartError(str(error)) from error

    def stop(self) -> None:
        self._ending.set()
        if self._server is not None:
            self._server.stop()


class Hushed:
    """Memory that answers nobody while the fault `mute` is on, and then what came meanwhile."""

    def __init__(self, memory: Memory, faults: Faults, ending: threading.Event) -> None:
        self._memory, self._faults, self._ending = memory, faults, ending

    def read(self, db: int) -> bytes:
        self._wait()
        return self._memory.read(db)

    def write(self, db: int, byte: int, data: bytes) -> None:
        self._wait()
        self._memory.write(db, byte, data)

    def _wait(self) -> None:
        while "mute" in self._faults and not self._ending.wait(TICK_S):
            pass
