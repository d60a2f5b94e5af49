"""Virtual PLC with the belt, whatever it speaks."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from arboleda.drivers import DriverError
from arboleda.extension import StartError


class Listener(Protocol):
    """Server of one protocol; `start` returns its port, or 0 where it has none."""

    def start(self) -> int: ...
    def stop(self) -> None: ...


class PlcServer:
    """Server of the belt, which listens from `start` to `stop`."""

    def __init__(self, says: str, need_library: Callable[[], None], make: Callable[[], Listener]) -> None:
        self._says, self._need_library, self._make = says, need_library, make
        self._server: Listener | None = None
        self.port = 0

    @property
    def says(self) -> str:
        where = f"{self._says}:{self.port}" if self.port else self._says
        return f"the virtual PLC speaks {where}"

    def start(self) -> None:
        """Listen; raises StartError if the library is missing, or the port cannot be opened."""
        try:
            self._need_library()
            self._server = self._make()
            self.port = self._server.start()
        except (OSError, DriverError) as error:
            raise StartError(str(error)) from error

    def stop(self) -> None:
        if self._server is not None:
            self._server.stop()
