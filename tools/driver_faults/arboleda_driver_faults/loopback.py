"""Driver's machine and virtual device, connected without a line, under a clock that is moved by hand."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Iterator, Sequence
from random import Random
from typing import Any, Generic, Protocol, TypeVar

from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Command
from arboleda.model.messages import Report
from arboleda_drivers.connections.link import CommandNotSent, CommandRequest
from arboleda_lines.line import CUT, Line

from .rig import Hear

Event = TypeVar("Event")  # what the driver hears
Said = TypeVar("Said")  # what the device hears


class Due(Protocol):
    """Something that is to be stepped at its next deadline at the latest."""

    @property
    def next_deadline(self) -> float: ...


class Machine(Due, Protocol):
    """The pure machine of a driver."""

    def step(self, now: float, events: Sequence[Any]) -> list[Any]: ...


class Loopback(ABC, Generic[Event, Said]):
    """Driver and virtual device, connected: each gets the other's messages as the `line` brings them, a good
    one at once.

    `hear` takes the reports that the plant would get; `given` counts the moves that the driver was given.
    """

    def __init__(self, driver: Machine, device: Due, hear: Hear, now: float) -> None:
        self.driver, self.now, self.given = driver, now, 0
        self._device, self._hear = device, hear
        self.line = Line(Random(0))
        self._to_driver: deque[Event] = deque()
        self._connected = False

    @property
    def next_deadline(self) -> float:
        due = (self._device.next_deadline, self.driver.next_deadline, self.line.next_deadline)
        return max(self.now, min(due))

    def ask(self, command: Command) -> str | None:
        """Command the device; returns the reason why the command could not leave, or None."""
        self.given += isinstance(command, MoveJoints)
        out = self._step_driver(CommandRequest(command=command))
        self._settle()
        return next((each.why for each in out if isinstance(each, CommandNotSent)), None)

    def pass_time(self, now: float) -> None:
        """Let both do everything due by now."""
        self.now = now
        self._step_device()
        self._step_driver()
        self._settle()

    def _settle(self) -> None:
        """Pass messages in order until neither has any left."""
        while True:
            for said in self.line.sent(self.now):
                self._step_device(said)
            self._to_driver.extend(self._arrived())
            if not self._to_driver:
                return
            while self._to_driver:
                self._step_driver(self._to_driver.popleft())

    def _arrived(self) -> Iterator[Event]:
        for message in self.line.arrived(self.now):
            if message is CUT:
                self.cut()
            else:
                yield message

    def cut(self) -> None:
        """End the connection, as where a gateway boots."""
        if self._connected:
            self.line.broken()
            self._hang_up()
            self._to_driver.append(self._closed("reset"))

    def _step_driver(self, *events: Event | CommandRequest) -> list[Any]:
        out = self.driver.step(self.now, events)
        for message in out:
            if isinstance(message, Report):
                self._hear(message)
            else:
                self._do(message)
        return out

    def _hang_up(self) -> None:
        """Let the device know that the connection has ended."""
        self._connected = False

    @abstractmethod
    def _closed(self, why: str) -> Event:
        """The event that tells the driver that the connection has ended."""

    @abstractmethod
    def _do(self, message: Any) -> None:
        """Do what the driver wants of its connection."""

    @abstractmethod
    def _step_device(self, *said: Said) -> None:
        """Let the device hear this, and pass what it says to the driver."""
