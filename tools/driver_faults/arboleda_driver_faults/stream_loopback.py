"""Driver and virtual device at one stream of bytes, connected without a line, under a clock moved by hand."""

from __future__ import annotations

from arboleda_drivers.connections.controller_machine import ControllerMachine
from arboleda_drivers.connections.link import Close, Closed, Open, Opened
from arboleda_drivers.connections.stream import Event, Message, Received, Write
from arboleda_drivers.virtual.pty_line import LineMachine

from . import loopback
from .rig import Hear


class Loopback(loopback.Loopback[Event, bytes]):
    """Driver and virtual device at a line; `written` keeps what the driver wrote."""

    def __init__(self, driver: ControllerMachine, far: LineMachine, hear: Hear, now: float) -> None:
        super().__init__(driver, far, hear, now)
        self.far = far
        self.written: list[bytes] = []

    def hear(self, data: bytes) -> None:
        """Have the driver hear bytes that the virtual device did not say."""
        self._to_driver.append(Received(data=data))
        self._settle()

    def _closed(self, why: str) -> Closed:
        return Closed(why=why)

    def _do(self, message: Message) -> None:
        if isinstance(message, Open):
            self._connected = not self.far.is_unplugged
            self._to_driver.append(Opened() if self._connected else Closed(why="no such file"))
            self.line.opened(self.now)
        elif isinstance(message, Close):
            self._connected = False
            self.line.closed()
            self._to_driver.clear()
        elif isinstance(message, Write) and self._connected:
            self.written.append(message.data)
            self.line.asks(self.now, message.data)
            self.line.echoes(self.now, Received(data=message.data))

    def _step_device(self, *said: bytes) -> None:
        answer = self.far.step(self.now, b"".join(said))
        if self._connected and self.far.is_unplugged:
            self._connected = False
            self._to_driver.append(Closed(why="the line is gone"))
        elif self._connected and answer:
            self.line.answers(self.now, Received(data=answer))
