"""Events and messages of a machine at one stream of bytes, a serial line or a TCP connection."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.drivers import DriverError, Report

from .link import Close, Closed, CommandNotSent, CommandRequest, Open, Opened


@dataclass(frozen=True, kw_only=True)
class StreamAddress:
    """Address of a stream: a serial line with its speed in baud, or a host with its TCP port."""

    serial: str = ""
    baud: int = 0
    host: str = ""
    port: int = 0

    def __post_init__(self) -> None:
        if bool(self.host) == bool(self.serial):
            raise DriverError("needs either serial (as /dev/ttyUSB0) or host, with port, of a serial server")
        if self.host and not 0 < self.port < 65536:
            raise DriverError(f"port is {self.port}; allowed: 1 to 65535")
        if self.serial and not 1200 <= self.baud <= 4_000_000:
            raise DriverError(f"baud is {self.baud}; allowed: 1200 to 4000000")

    @property
    def peer(self) -> str:
        """The name of the other end for sentences."""
        return self.serial or f"{self.host}:{self.port}"


@dataclass(frozen=True, kw_only=True)
class Received:
    """Event: bytes from the stream."""

    data: bytes


@dataclass(frozen=True, kw_only=True)
class Write:
    """Message: write these bytes to the stream."""

    data: bytes


Event = Opened | Closed | Received | CommandRequest
Message = Open | Close | Write | CommandNotSent | Report
