"""Driver and virtual arm of Universal Robots, connected without sockets, under a clock of their own."""

from __future__ import annotations

from arboleda.model.plant_model import Robot
from arboleda_drivers.connections.link import Close, Closed, Open, Opened
from arboleda_drivers.ur.machine import Machine, Message
from arboleda_drivers.ur.port_data import DASHBOARD, PRIMARY, RTDE, Received, Send
from arboleda_drivers.ur.settings import Settings
from arboleda_drivers.ur.virtual.machine import ClientData, Disconnect, Event, Joined, ToClient, VirtualUr

from . import loopback
from .rig import Hear

PORTS = (DASHBOARD, RTDE, PRIMARY)
BY_HAND = -1  # the client that is another one than the driver


class Loopback(loopback.Loopback[Closed | Opened | Received, Event]):
    """Driver and virtual arm."""

    def __init__(self, arm: Robot, ur: VirtualUr, hear: Hear, now: float) -> None:
        super().__init__(Machine([arm], Settings(host="ur")), ur, hear, now)
        self.ur = ur
        self.lines: list[str] = []  # of the dashboard
        self.programs: list[str] = []
        self._first = 1  # the number of the dashboard's client; those of the other ports follow

    def tell(self, line: str) -> None:
        """Send a line as another client of the dashboard."""
        joined = Joined(client=BY_HAND, port=DASHBOARD)
        self._step_device(joined, ClientData(client=BY_HAND, port=DASHBOARD, data=line.encode() + b"\n"))
        self._settle()

    def _do(self, message: Message) -> None:
        if isinstance(message, Open):
            self._connect()
        elif isinstance(message, Close):
            self._hang_up()
            self._to_driver.clear()
        elif isinstance(message, Send) and self._connected:
            if message.port != RTDE:
                said = self.lines if message.port == DASHBOARD else self.programs
                said.append(message.data.decode().strip())
            client = self._first + PORTS.index(message.port)
            self._to_device.append(ClientData(client=client, port=message.port, data=message.data))

    def _connect(self) -> None:
        self._connected = not self.ur.is_off
        if not self._connected:
            self._to_driver.append(Closed(why="refused"))
            return
        self._first += len(PORTS)
        self._to_device.extend(Joined(client=self._first + n, port=port) for n, port in enumerate(PORTS))
        self._to_driver.append(Opened())

    def _hang_up(self) -> None:
        if self._connected:
            ends = (ClientData(client=self._first + n, port=port, data=b"") for n, port in enumerate(PORTS))
            self._to_device.extend(ends)
        self._connected = False

    def _step_device(self, *events: Event) -> None:
        for message in self.ur.step(self.now, events):
            if not self._connected:
                continue
            if isinstance(message, ToClient):
                if 0 <= message.client - self._first < len(PORTS):
                    port = PORTS[message.client - self._first]
                    self._to_driver.append(Received(port=port, data=message.data))
            elif isinstance(message, Disconnect) or message.client >= self._first:
                self._connected = False
                self._to_driver.append(Closed(why="hung up"))
