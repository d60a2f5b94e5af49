"""S7 server for somebody else's data blocks: python-snap7 speaks, `Memory` answers."""

from __future__ import annotations

import logging
import socket
from collections.abc import Collection
from typing import Any, Protocol

SIZE = 64  # bytes of each data block


class Memory(Protocol):
    """Data blocks of a PLC; called in a thread of the server for each connection.

    Both may raise ValueError: the request is refused.
    """

    def read(self, db: int) -> bytes:
        """All bytes of a data block."""

    def write(self, db: int, byte: int, data: bytes) -> None:
        """Take bytes; the server gives a bit as a byte, 0 or 1, whatever its neighbours were."""


class Block(bytearray):
    """Data block as python-snap7 keeps it; its bytes come from a memory whenever they are read."""

    def __init__(self, memory: Memory, db: int) -> None:
        super().__init__(SIZE)
        self._memory, self._db = memory, db

    def __getitem__(self, at: Any) -> Any:
        return bytearray(self._memory.read(self._db).ljust(SIZE, b"\0"))[at]

    def __setitem__(self, at: Any, data: Any) -> None:
        self._memory.write(self._db, at.start, bytes(data))


class S7Server:
    """Serves the data blocks of one memory, from `start` to `stop`."""

    def __init__(
        self, memory: Memory, dbs: Collection[int] = (1, 2), *, host: str = "127.0.0.1", port: int = 0
    ) -> None:
        from snap7.server import Server
        from snap7.type import SrvArea

        logging.getLogger("snap7").setLevel(logging.CRITICAL)
        self._host, self._port = host, port
        self._server = Server(log=False)
        for db in dbs:
            self._server.register_area(SrvArea.DB, db, Block(memory, db))

    def start(self) -> int:
        """Listen, and return the port; raises OSError if that is impossible."""
        from snap7.error import S7Error

        port = self._port
        try:
            port = _free(self._host, port)
            self._server.start_to(self._host, port)
        except (OSError, S7Error, ValueError) as error:
            what = f"nothing can listen on {self._host}:{port}"
            raise OSError(f"{what}; name another port, or 0 for any that is free") from error
        return port

    def stop(self) -> None:
        """End every connection and stop listening."""
        self._server.stop()


def _free(host: str, port: int) -> int:
    """The port, any for 0, on which nobody listens now; the library would share it with whoever does."""
    with socket.create_server((host, port)) as found:
        return int(found.getsockname()[1])
