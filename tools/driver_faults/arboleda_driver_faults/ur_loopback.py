"""Driver and virtual arm of Universal Robots, connected without sockets, under a clock of their own."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from arboleda.model.commands import Command
from arboleda.model.messages import Report
from arboleda.model.plant_model import Robot
from arboleda_drivers.connections.link import Close, Closed, CommandNotSent, CommandRequest, Open, Opened
from arboleda_drivers.ur.machine import DASHBOARD, PRIMARY, RTDE, Machine, Message
from arboleda_drivers.ur.port_data import Received, Send
from arboleda_drivers.ur.settings import Settings
from arboleda_drivers.ur.virtual.machine import ClientData, Disconnect, Event, Joined, ToClient, VirtualUr

PORTS = (DASHBOARD, RTDE, PRIMARY)
BY_HAND = -1  # the client that is another one than the driver


class Loopback:
    """Driver and virtual arm, connected: each gets the other's messages at once.

    `hear` takes the reports that the plant would get of the arm.
    """

    def __init__(self, arm: Robot, ur: VirtualUr, hear: Callable[[Report], None], now: float) -> None:
        self.ur = ur
        self.driver = Machine([arm], Settings(host="ur"))
        self.now = now
        self.lines: list[str] = []  # of the dashboard
        self.programs: list[str] = []
        self._hear = hear
        self._to_ur: deque[Event] = deque()
        self._to_driver: deque[Closed | Opened | Received] = deque()
        self._first = 1  # the number of the dashboard's client; those of the other ports follow
        self._connected = False

    @property
    def next_deadline(self) -> float:
        return max(self.now, min(self.ur.next_deadline, self.driver.next_deadline))

    def ask(self, command: Command) -> str | None:
        """Command the arm; returns the reason why the command could not leave, or None."""
        out = self._step_driver(CommandRequest(command=command))
        self._settle()
        return next((each.why for each in out if isinstance(each, CommandNotSent)), None)

    def tell(self, line: str) -> None:
        """Send a line as another client of the dashboard."""
        joined = Joined(client=BY_HAND, port=DASHBOARD)
        self._step_ur(joined, ClientData(client=BY_HAND, port=DASHBOARD, data=line.encode() + b"\n"))
        self._settle()

    def pass_time(self, now: float) -> None:
        """Let both do everything due by now."""
        self.now = now
        self._step_ur()
        self._step_driver()
        self._settle()

    def _settle(self) -> None:
        """Pass messages in order until neither has any left."""
        while self._to_ur or self._to_driver:
            while self._to_ur:
                self._step_ur(self._to_ur.popleft())
            while self._to_driver:
                self._step_driver(self._to_driver.popleft())

    def _step_driver(self, *events: CommandRequest | Closed | Opened | Received) -> list[Message]:
        out = self.driver.step(self.now, events)
        for message in out:
            self._do(message)
        return out

    def _do(self, message: Message) -> None:
        if isinstance(message, Report):
            self._hear(message)
        elif isinstance(message, Open):
            self._connect()
        elif isinstance(message, Close):
            self._hang_up()
            self._to_driver.clear()
        elif isinstance(message, Send) and self._connected:
            if message.port != RTDE:
                said = self.lines if message.port == DASHBOARD else self.programs
                said.append(message.data.decode().strip())
            client = self._first + PORTS.index(message.port)
            self._to_ur.append(ClientData(client=client, port=message.port, data=message.data))

    def _connect(self) -> None:
        self._connected = not self.ur.is_off
        if not self._connected:
            self._to_driver.append(Closed(why="refused"))
            return
        self._first += len(PORTS)
        self._to_ur.extend(Joined(client=self._first + n, port=port) for n, port in enumerate(PORTS))
        self._to_driver.append(Opened())

    def _hang_up(self) -> None:
        if self._connected:
            ends = (ClientData(client=self._first + n, port=port, data=b"") for n, port in enumerate(PORTS))
            self._to_ur.extend(ends)
        self._connected = False

    def _step_ur(self, *events: Event) -> None:
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
