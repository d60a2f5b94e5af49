"""Driver and virtual Dobot, connected without sockets, under a clock that is moved by hand."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from arboleda.model.commands import Command
from arboleda.model.messages import Report
from arboleda.model.plant_model import Robot
from arboleda_drivers.connections.link import Close, Closed, CommandNotSent, CommandRequest, Open, Opened
from arboleda_drivers.dobot.machine import DashboardReply, Event, FeedbackData, Machine, Message, SendLine
from arboleda_drivers.dobot.settings import Settings
from arboleda_drivers.dobot.virtual.machine import Answer, ClientText, Disconnect, Frame, VirtualDobot


class Loopback:
    """Driver and virtual Dobot, connected: each gets the other's messages at once.

    `hear` takes the reports that the plant would get of the arm.
    """

    def __init__(self, arm: Robot, dobot: VirtualDobot, hear: Callable[[Report], None], now: float) -> None:
        self.dobot = dobot
        self.driver = Machine([arm], Settings(host="dobot"))
        self.now = now
        self.received: list[str] = []  # lines of the dashboard
        self._hear = hear
        self._to_dobot: deque[ClientText] = deque()
        self._to_driver: deque[Event] = deque()
        self._client = 0  # grows with each connection; 0: there is none
        self._connected = False

    @property
    def next_deadline(self) -> float:
        return max(self.now, min(self.dobot.next_deadline, self.driver.next_deadline))

    def ask(self, command: Command) -> str | None:
        """Command the arm; returns the reason why the command could not leave, or None."""
        out = self._step_driver(CommandRequest(command=command))
        self._settle()
        return next((each.why for each in out if isinstance(each, CommandNotSent)), None)

    def tell(self, line: str) -> None:
        """Send a line as another client of the dashboard."""
        self.dobot.step(self.now, [ClientText(client=-1, text=line)])

    def pass_time(self, now: float) -> None:
        """Let both do everything due by now."""
        self.now = now
        self._step_dobot()
        self._step_driver()
        self._settle()

    def _settle(self) -> None:
        """Pass messages in order until neither has any left."""
        while self._to_dobot or self._to_driver:
            while self._to_dobot:
                self._step_dobot(self._to_dobot.popleft())
            while self._to_driver:
                self._step_driver(self._to_driver.popleft())

    def _step_driver(self, *events: Event) -> list[Message]:
        out = self.driver.step(self.now, events)
        for message in out:
            self._do(message)
        return out

    def _do(self, message: Message) -> None:
        if isinstance(message, Report):
            self._hear(message)
        elif isinstance(message, Open):
            off = self.dobot.is_off
            self._connected = not off
            self._client += 1
            self._to_driver.append(Closed(why="refused") if off else Opened())
        elif isinstance(message, Close):
            self._connected = False
            self._to_driver.clear()
        elif isinstance(message, SendLine) and self._connected:
            self.received.append(message.text)
            self._to_dobot.append(ClientText(client=self._client, text=message.text))

    def _step_dobot(self, *said: ClientText) -> None:
        for message in self.dobot.step(self.now, said):
            if not self._connected:
                continue
            if isinstance(message, Disconnect):
                self._connected = False
                self._to_driver.append(Closed(why="hung up"))
            elif isinstance(message, Frame):
                self._to_driver.append(FeedbackData(data=message.data))
            elif isinstance(message, Answer) and message.client == self._client:
                self._to_driver.append(DashboardReply(data=message.text.encode()))
