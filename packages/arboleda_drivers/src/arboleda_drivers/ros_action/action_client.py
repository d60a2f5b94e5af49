"""Base of the drivers of actions: an action client, subscriptions and a timer around their machine.

Plant files are read without rclpy and without the messages: where they are missing, the start says so.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from typing import Any, ClassVar

from arboleda.drivers import Clock, Command, Hear, NotSent, Report, Robot
from arboleda_drivers.connections.device_feed import taking
from arboleda_drivers.connections.link import CommandNotSent, CommandRequest
from arboleda_drivers.ros_action.action_link import ActionLink
from arboleda_drivers.ros_action.events import (
    CancelAll,
    Event,
    MakeCall,
    Measurement,
    Message,
    SendGoal,
    UnusableMessage,
)
from arboleda_drivers.ros_action.health_link import HealthLink
from arboleda_drivers.ros_action.interfaces import interface
from arboleda_drivers.ros_action.machine import Machine

with suppress(ImportError):
    # Drivers start in threads of their own, and two threads that import rclpy at once both fail.
    import rclpy.action  # noqa: F401

    import arboleda_ros.link  # noqa: F401

LOOK_S = 0.1  # between two looks at which servers there are


class ActionClientDriver:
    """Driver of one device behind one action. All of ROS 2 is done in one thread of its link."""

    package: ClassVar[str]  # of the action's messages

    def __init__(self, settings: Any) -> None:
        self.settings = settings
        self._lock = threading.Lock()  # around the machine and what it reports
        self._link: Any = None
        self._client: ActionLink
        self._health: HealthLink | None = None

    # What each of them has of its own.

    @property
    def type_name(self) -> str:
        """The name of the action in its package."""
        raise NotImplementedError

    def machine(self, devices: Sequence[Robot]) -> Machine:
        """The machine for these devices, which takes answers and measurements."""
        raise NotImplementedError

    def listen(self, node: Any) -> None:
        """Subscribe to the measurements of the device, and pass them to `see`."""
        raise NotImplementedError

    def goal(self, action: Any, goal: Any) -> Any:
        """A goal of the machine as a message."""
        raise NotImplementedError

    def end(self, result: Any) -> dict[str, Any]:
        """The fields of GoalResult that the action's result gives."""
        raise NotImplementedError

    # What all of them do.

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        self._hear, self._clock = hear, clock
        self._machine = self.machine(devices)
        self._action = interface(f"{self.package}/action/{self.type_name}")
        from arboleda_ros.link import connect

        self._link = connect(lan=self.settings.lan)
        self._join(self._link.node(f"{devices[0].name}_driver"))
        self._link.start()

    def send(self, command: Command) -> None:
        for message in self._step(CommandRequest(command=command)):
            if isinstance(message, CommandNotSent):
                raise NotSent(message.why)

    def stop(self) -> None:
        if self._link is not None:
            self._link.close()

    def see(self, measurement: Measurement) -> None:
        """Take a measurement, in the thread of ROS 2."""
        self._take(measurement, measurement)

    def _join(self, node: Any) -> None:
        from rclpy.clock import Clock as RosClock
        from rclpy.clock import ClockType

        self._node = node
        name = self.settings.action
        self._client = ActionLink(node, self._action, name, self._step, self._lose, self.end)
        self.listen(node)
        health = getattr(self.settings, "health", None)
        if health is not None:
            self._health = HealthLink(node, health, self._take)
        node.create_timer(LOOK_S, self._look, clock=RosClock(clock_type=ClockType.STEADY_TIME))

    def _step(self, *events: Event) -> list[Message]:
        with self._lock:
            messages = self._machine.step(self._clock(), events)
            for message in messages:
                if isinstance(message, Report):
                    self._hear(message)
                elif isinstance(message, SendGoal):
                    self._later(partial(self._send_goal, message))
                elif isinstance(message, CancelAll):
                    self._later(self._client.cancel_all)
                elif isinstance(message, MakeCall) and self._health is not None:
                    self._later(partial(self._health.make, message.call))
        return messages

    def _take(self, message: Any, event: Event) -> None:
        """Pass an event from server or device to the machine; an unreadable value loses the link."""
        with taking(message, self._lose):
            self._step(event)

    def _lose(self, why: str) -> None:
        self._step(UnusableMessage(why=why))

    def _later(self, what: Callable[[], None]) -> None:
        """Call a function in the thread of ROS 2, as an action client is not thread-safe."""
        self._node.executor.create_task(what)

    def _send_goal(self, message: SendGoal) -> None:
        self._client.send(message.id, message.uuid, self.goal(self._action, message.goal))

    def _look(self) -> None:
        self._step(self._client.servers())


def stamp_of(message: Any) -> tuple[int, int]:
    """The time of measurement in a message's header, (s, ns)."""
    stamp = message.header.stamp
    return (stamp.sec, stamp.nanosec)
