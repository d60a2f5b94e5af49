"""Virtual S7, which serves the belt's data blocks."""

from __future__ import annotations

import threading
import time
from functools import partial

from arboleda_drivers.plc.virtual.server import PlcServer
from arboleda_drivers.s7.adapter import need_library
from arboleda_drivers.s7.server import Memory, S7Server
from arboleda_drivers.virtual.faults import Faults

from .memory import BeltMemory

TICK_S = 0.02


class Server(PlcServer):
    """Server of the belt, which listens from `start` to `stop`."""

    def __init__(self, faults: Faults, *, host: str = "127.0.0.1", port: int = 0) -> None:
        self._memory = Hushed(BeltMemory(faults, time.monotonic), faults)
        make = partial(S7Server, self._memory, host=host, port=port)
        super().__init__(f"S7 on {host}", need_library, make)

    def stop(self) -> None:
        self._memory.end()
        super().stop()


class Hushed:
    """Memory that answers nobody while the fault `mute` is on, and then what came meanwhile."""

    def __init__(self, memory: Memory, faults: Faults) -> None:
        self._memory, self._faults = memory, faults
        self._ending = threading.Event()

    def end(self) -> None:
        self._ending.set()

    def read(self, db: int) -> bytes:
        self._wait()
        return self._memory.read(db)

    def write(self, db: int, byte: int, data: bytes) -> None:
        self._wait()
        self._memory.write(db, byte, data)

    def _wait(self) -> None:
        while "mute" in self._faults and not self._ending.wait(TICK_S):
            pass
