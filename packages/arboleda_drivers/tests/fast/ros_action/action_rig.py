"""The machine of a device behind an action, without ROS 2: a test plays the server, and what is measured."""

from __future__ import annotations

from abc import ABC, abstractmethod

from arboleda.drivers import Report
from arboleda.model.commands import Command
from arboleda_drivers.connections.link import CommandRequest
from arboleda_drivers.ros_action.events import (
    Event,
    GoalAnswer,
    Message,
    ServersFound,
)
from arboleda_drivers.ros_action.machine import Machine

SERVER = 7


class ActionRig(ABC):
    """The machine under a clock that the test moves; server and device are seen 20 times a second."""

    def __init__(self, machine: Machine) -> None:
        self.machine, self.now = machine, 100.0
        self.servers: tuple[int, ...] = (SERVER,)
        self.said: list[Message] = []

    @abstractmethod
    def measure(self) -> None:
        """Tell what is measured of the device now."""

    def wait(self, s: float) -> None:
        end = self.now + s
        while self.now < end:
            self.now += 0.05
            self.tell(ServersFound(servers=self.servers))
            self.measure()

    def tell(self, *events: Event) -> list[Message]:
        news = self.machine.step(self.now, events)
        self.said += news
        return news

    def ask(self, command: Command) -> list[Message]:
        return self.tell(CommandRequest(command=command))

    def begin(self, command: Command) -> None:
        """Give a command, whose goal the server accepts."""
        self.ask(command)
        self.tell(GoalAnswer(id=command.id, accepted=True))

    @property
    def last(self) -> Report:
        return [each for each in self.said if isinstance(each, Report)][-1]

    def count(self, kind: type) -> int:
        return sum(isinstance(each, kind) for each in self.said)
