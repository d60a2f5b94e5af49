"""Base of drivers over TCP: the connections to a controller's ports."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from arboleda.drivers import Robot
from arboleda_drivers.connections.controller_machine import ControllerMachine
from arboleda_drivers.connections.link import Opened

from .stream_driver import Event, MachineDriver, Streams, TcpStream

Make = Callable[[Sequence[Robot]], ControllerMachine]


class TcpPorts(MachineDriver):
    """Driver of one controller with several ports.

    `ports` has the event that the machine gets for the bytes of each port, by its number.
    """

    def __init__(self, make: Make, *, host: str, ports: Mapping[int, Event]) -> None:
        super().__init__()
        self._make, self._host, self._ports = make, host, ports
        self._open: dict[int, TcpStream] = {}

    def machine(self, devices: Sequence[Robot]) -> ControllerMachine:
        return self._make(devices)

    def connect(self) -> tuple[Opened, Streams]:
        opened: dict[int, TcpStream] = {}
        try:
            for port in self._ports:
                opened[port] = TcpStream(self._host, port)
        except OSError as error:
            for each in opened.values():
                each.close()
            raise OSError(f"port {port}: {error}") from error
        self._open = opened
        return Opened(), {stream: self._ports[port] for port, stream in opened.items()}

    def write(self, message: object) -> None:
        sent = self.data_of(message)
        if sent is not None and (stream := self._open.get(sent[0])):
            stream.write(sent[1])

    def data_of(self, message: Any) -> tuple[int, bytes] | None:
        """The number of a port, and the bytes that a message of the machine sends there; None for others."""
        raise NotImplementedError
