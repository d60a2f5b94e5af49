"""Base of the drivers over ROS 2: a machine, and the link in whose thread its messages are carried out.

Plant files are read without rclpy and without the messages: where they are missing, the start says so.
"""

from __future__ import annotations

import threading
from abc import ABC, abstractmethod
from collections.abc import Sequence
from contextlib import suppress
from functools import partial
from typing import Any

from arboleda.drivers import Clock, Command, Hear, NotSent, Report, Robot
from arboleda_drivers.connections.device_feed import taking
from arboleda_drivers.connections.link import CommandNotSent, CommandRequest
from arboleda_drivers.ros_action.events import UnusableMessage

with suppress(ImportError):
    # Drivers start in threads of their own, and two threads that import rclpy at once both fail.
    import rclpy.action  # noqa: F401

    import arboleda_ros.link  # noqa: F401

LOOK_S = 0.1  # between two looks at who is at the other ends


class RosDriver(ABC):
    """Driver over ROS 2; `join`, `look` and `do` of a subclass are called in the thread of ROS 2."""

    def __init__(self, settings: Any) -> None:
        self.settings = settings
        self._lock = threading.Lock()  # around the machine and what it reports
        self._link: Any = None

    # What each of them has of its own.

    @abstractmethod
    def machine(self, devices: Sequence[Robot]) -> Any:
        """The machine for these devices; raises DriverError where a type is missing."""

    @abstractmethod
    def join(self, node: Any) -> None:
        """Make what reaches the other ends."""

    @abstractmethod
    def look(self) -> Any:
        """The event of who is at the other ends."""

    @abstractmethod
    def do(self, message: Any) -> None:
        """Carry out a message of the machine, as clients of ROS 2 are not thread-safe."""

    def request(self, command: Command) -> Any:
        """The event of a command; raises NotSent if it cannot be made a message."""
        return CommandRequest(command=command)

    # What all of them do.

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        self._hear, self._clock = hear, clock
        self._machine = self.machine(devices)
        from rclpy.clock import Clock as RosClock
        from rclpy.clock import ClockType

        from arboleda_ros.link import connect

        self._link = connect(lan=self.settings.lan)
        self.node = self._link.node(f"{devices[0].name}_driver")
        self.join(self.node)
        self.node.create_timer(LOOK_S, self._look, clock=RosClock(clock_type=ClockType.STEADY_TIME))
        self._link.start()

    def send(self, command: Command) -> None:
        for message in self.step(self.request(command)):
            if isinstance(message, CommandNotSent):
                raise NotSent(message.why)

    def stop(self) -> None:
        if self._link is not None:
            self._link.close()

    def step(self, *events: Any) -> Sequence[Any]:
        """Pass events to the machine, and do what follows."""
        with self._lock:
            messages: Sequence[Any] = self._machine.step(self._clock(), events)
            for message in messages:
                if isinstance(message, Report):
                    self._hear(message)
                elif not isinstance(message, CommandNotSent):
                    self.node.executor.create_task(partial(self.do, message))
        return messages

    def take(self, message: Any, event: Any) -> None:
        """Pass what a device has said to the machine; an unreadable value loses the link."""
        with taking(message, self.lose):
            self.step(event)

    def lose(self, why: str) -> None:
        """Lose the link, as something that was said cannot be used."""
        self.step(UnusableMessage(why=why))

    def _look(self) -> None:
        self.step(self.look())
