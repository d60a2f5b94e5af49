"""Driver and virtual Dobot, connected without sockets, under a clock that is moved by hand."""

from __future__ import annotations

from arboleda.model.plant_model import Robot
from arboleda_drivers.connections.link import Close, Closed, Open, Opened
from arboleda_drivers.dobot.dashboard import SendLine
from arboleda_drivers.dobot.machine import DashboardReply, Event, FeedbackData, Machine, Message
from arboleda_drivers.dobot.settings import Settings
from arboleda_drivers.dobot.virtual.machine import Answer, ClientText, Disconnect, Frame, VirtualDobot

from . import loopback
from .rig import Hear


class Loopback(loopback.Loopback[Event, ClientText]):
    """Driver and virtual Dobot."""

    def __init__(self, arm: Robot, dobot: VirtualDobot, hear: Hear, now: float) -> None:
        super().__init__(Machine([arm], Settings(host="dobot")), dobot, hear, now)
        self.dobot = dobot
        self.received: list[str] = []  # lines of the dashboard
        self._client = 0  # grows with each connection; 0: there is none

    def tell(self, line: str) -> None:
        """Send a line as another client of the dashboard."""
        self.dobot.step(self.now, [ClientText(client=-1, text=line)])

    def _do(self, message: Message) -> None:
        if isinstance(message, Open):
            off = self.dobot.is_off
            self._connected = not off
            self._client += 1
            self._to_driver.append(Closed(why="refused") if off else Opened())
        elif isinstance(message, Close):
            self._connected = False
            self._to_driver.clear()
        elif isinstance(message, SendLine) and self._connected:
            self.received.append(message.text)
            self._to_device.append(ClientText(client=self._client, text=message.text))

    def _step_device(self, *said: ClientText) -> None:
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
