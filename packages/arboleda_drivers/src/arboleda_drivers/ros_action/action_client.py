"""Base of the drivers of actions: an action client, subscriptions and a timer around their machine.

Plant files are read without rclpy and without the messages: where they are missing, the start says so.
"""

from __future__ import annotations

import os
import threading
import zlib
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from importlib import import_module
from typing import Any, ClassVar

from arboleda.drivers import Clock, Command, DriverError, Hear, NotSent, Report, Robot
from arboleda_drivers.connections.device_feed import taking
from arboleda_drivers.ros_action.events import (
    CancelAll,
    CancelAnswer,
    CommandNotSent,
    CommandRequest,
    Event,
    GoalAnswer,
    GoalList,
    GoalResult,
    ListedGoal,
    MakeCall,
    Measurement,
    Message,
    SendGoal,
    ServersFound,
    Status,
    UnusableMessage,
)
from arboleda_drivers.ros_action.health_link import HealthLink
from arboleda_drivers.ros_action.machine import Machine

with suppress(ImportError):
    # Drivers start in threads of their own, and two threads that import rclpy at once both fail.
    import rclpy.action  # noqa: F401

    import arboleda_ros.link  # noqa: F401

LOOK_S = 0.1  # between two looks at which servers there are
REJECTED = 1  # CancelGoal: the server goes on with what it does
STATUSES = {4: Status.SUCCEEDED, 5: Status.CANCELED, 6: Status.ABORTED}
"""The ends of a goal in action_msgs/msg/GoalStatus."""


class ActionClientDriver:
    """Driver of one device behind one action. All of ROS 2 is done in one thread of its link."""

    package: ClassVar[str]  # of the action's messages

    def __init__(self, settings: Any) -> None:
        self.settings = settings
        self._lock = threading.Lock()  # around the machine and what it reports
        self._link: Any = None
        self._client: Any = None
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
        self._action = action_type(self.package, self.type_name)
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
        from action_msgs.msg import GoalStatusArray
        from action_msgs.srv import CancelGoal
        from rclpy.action import ActionClient
        from rclpy.clock import Clock as RosClock
        from rclpy.clock import ClockType
        from rclpy.qos import qos_profile_action_status_default

        name = self.settings.action
        self._node = node
        self._client = ActionClient(node, self._action, name)
        self._cancels = node.create_client(CancelGoal, f"{name}/_action/cancel_goal")
        latched = qos_profile_action_status_default
        node.create_subscription(GoalStatusArray, f"{name}/_action/status", self._list, latched)
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
                    self._later(self._cancel_all)
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

    # What leaves.

    def _send_goal(self, message: SendGoal) -> None:
        from unique_identifier_msgs.msg import UUID

        goal, uuid = self.goal(self._action, message.goal), UUID(uuid=list(message.uuid))
        sent = self._client.send_goal_async(goal, goal_uuid=uuid)
        sent.add_done_callback(partial(self._answered, message.id))

    def _cancel_all(self) -> None:
        from action_msgs.srv import CancelGoal

        # A request without an id and a time means all goals, those of other clients among them.
        self._cancels.call_async(CancelGoal.Request()).add_done_callback(self._cancelled)

    # What comes back, in the thread of ROS 2.

    def _answered(self, id: str, future: Any) -> None:
        handle = future.result()
        self._take(handle, GoalAnswer(id=id, accepted=handle.accepted))
        if handle.accepted:
            handle.get_result_async().add_done_callback(partial(self._ended, id))

    def _ended(self, id: str, future: Any) -> None:
        response = future.result()
        status = STATUSES.get(response.status, Status.UNKNOWN)
        with taking(response, self._lose):
            self._step(GoalResult(id=id, status=status, **self.end(response.result)))

    def _list(self, message: Any) -> None:
        goals = (
            ListedGoal(
                uuid=bytes(each.goal_info.goal_id.uuid),
                stamp=(each.goal_info.stamp.sec, each.goal_info.stamp.nanosec),
                status=STATUSES.get(each.status),
            )
            for each in message.status_list
        )
        self._take(message, GoalList(goals=tuple(goals)))

    def _cancelled(self, future: Any) -> None:
        response = future.result()
        self._take(response, CancelAnswer(refused=response.return_code == REJECTED))

    def _look(self) -> None:
        """Look for servers: each publishes the states of its goals by an endpoint of its own."""
        topic = self._node.resolve_topic_name(f"{self.settings.action}/_action/status")
        found = self._node.get_publishers_info_by_topic(topic)
        ready = bool(found) and self._client.server_is_ready()
        servers = tuple(sorted(zlib.crc32(bytes(each.endpoint_gid)) for each in found)) if ready else ()
        self._step(ServersFound(servers=servers))


def stamp_of(message: Any) -> tuple[int, int]:
    """The time of measurement in a message's header, (s, ns)."""
    stamp = message.header.stamp
    return (stamp.sec, stamp.nanosec)


def action_type(package: str, name: str) -> Any:
    """The type of an action; raises DriverError with install advice if its package is missing."""
    try:
        return getattr(import_module(f"{package}.action"), name)
    except ImportError as error:
        why = f"the message package {package}, which cannot be imported here ({error})"
    except AttributeError:
        why = f"the action {name} of the message package {package}, which is too old here"
    distro = os.environ.get("ROS_DISTRO", "$ROS_DISTRO")
    apt = f"ros-{distro}-{package.replace('_', '-')}"
    raise DriverError(f"it needs {why}: sudo apt install {apt}, and source that ROS 2")
