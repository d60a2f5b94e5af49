"""Base of the drivers of one action: an action client, and subscriptions to what measures the device."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

from arboleda.drivers import Robot
from arboleda_drivers.ros_action.action_link import ActionLink
from arboleda_drivers.ros_action.events import Event, MakeCall, Measurement, SendGoal
from arboleda_drivers.ros_action.health_link import HealthLink
from arboleda_drivers.ros_action.interfaces import interface
from arboleda_drivers.ros_action.machine import Machine
from arboleda_drivers.ros_action.ros_driver import RosDriver


class ActionClientDriver(RosDriver):
    """Driver of one device behind one action."""

    package: ClassVar[str]  # of the action's messages
    _client: ActionLink
    _health: HealthLink | None = None

    # What each of them has of its own.

    @property
    def type_name(self) -> str:
        """The name of the action in its package."""
        raise NotImplementedError

    def mover(self, devices: Sequence[Robot]) -> Machine:
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

    def machine(self, devices: Sequence[Robot]) -> Machine:
        self._action = interface(f"{self.package}/action/{self.type_name}")
        return self.mover(devices)

    def join(self, node: Any) -> None:
        name = self.settings.action
        self._client = ActionLink(node, self._action, name, self.step, self.lose, self.end)
        self.listen(node)
        health = getattr(self.settings, "health", None)
        if health is not None:
            self._health = HealthLink(node, health, self.take)

    def see(self, measurement: Measurement) -> None:
        """Take a measurement, in the thread of ROS 2."""
        self.take(measurement, measurement)

    def look(self) -> Event:
        return self._client.servers()

    def do(self, message: Any) -> None:
        if isinstance(message, SendGoal):
            self._client.send(message.id, message.uuid, self.goal(self._action, message.goal))
        elif isinstance(message, MakeCall):
            assert self._health is not None
            self._health.make(message.call)
        else:
            self._client.cancel_all()


def stamp_of(message: Any) -> tuple[int, int]:
    """The time of measurement in a message's header, (s, ns)."""
    stamp = message.header.stamp
    return (stamp.sec, stamp.nanosec)
