"""An action server of rclpy that does what a virtual machine says; switched off, it leaves ROS 2."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from arboleda.drivers import DriverError
from arboleda.extension import StartError
from arboleda_drivers.ros_action.events import GoalAnswer, GoalResult, Measurement, Status
from arboleda_drivers.ros_action.interfaces import interface
from arboleda_drivers.ros_action.virtual.machine import (
    CancelDecision,
    CancelRequest,
    GoalRequest,
    VirtualServer,
)

STEP_S = 0.002
OFF_S = 0.05


@dataclass(frozen=True, kw_only=True)
class Protocol:
    """Parts of the server that differ from action to action.

    `goal` reads one, `result` fills one in, and `sensors` makes what publishes measurements by a node.
    """

    package: str
    type_name: str
    goal: Callable[[Any], Any]
    result: Callable[[Any, GoalResult], None]
    sensors: Callable[[Any], Callable[[Measurement], None]]


class ActionController:
    """Virtual controller over ROS 2, from `start` to `stop`; everything runs in one thread."""

    def __init__(
        self, machine: VirtualServer, protocol: Protocol, *, action: str, what: str, lan: bool
    ) -> None:
        self._machine, self._protocol = machine, protocol
        self._action, self._what, self._lan = action, what, lan
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="virtual", daemon=True)
        self._type: Any = None

    @property
    def says(self) -> str:
        return f"{self._what} serves the action {self._action}"

    def start(self) -> None:
        """Start; raises StartError if ROS 2 or its messages are missing."""
        import os

        try:
            from arboleda_ros.link import limit_discovery
        except ImportError as error:
            why = f"{self._what} needs ROS 2, which cannot be used here ({error})"
            raise StartError(f"{why}; source a ROS 2, or python3 -m pip install 'arboleda[ros]'") from error
        try:
            self._type = interface(f"{self._protocol.package}/action/{self._protocol.type_name}")
        except DriverError as error:
            raise StartError(f"{self._what} cannot be played: {error}") from error
        limit_discovery(os.environ, lan=self._lan)
        self._thread.start()

    def stop(self) -> None:
        self._ending.set()
        self._thread.join()

    def _run(self) -> None:
        while not self._ending.is_set():
            if self._machine.is_off:
                self._machine.step(time.monotonic(), [])
                self._ending.wait(OFF_S)
            else:
                Life(self._machine, self._protocol, self._type, self._action).run(self._ending)


class Life:
    """Server from one start to its end."""

    def __init__(self, machine: VirtualServer, protocol: Protocol, type: Any, action: str) -> None:
        from rclpy.context import Context
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.node import Node

        self._machine, self._protocol, self._type, self._action = machine, protocol, type, action
        self._count = 0
        self._answers: dict[str, Any] = {}  # futures of what clients wait for
        self._cancels: dict[str, Any] = {}
        self._results: dict[str, Any] = {}
        self._handles: dict[str, Any] = {}
        self._accepted = ""  # the goal whose handle comes next
        self._context = Context()
        self._context.init()
        self._node = Node("virtual_controller", context=self._context)
        self._publish = protocol.sensors(self._node)
        self._servers = [self._serve()]
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)

    def run(self, ending: threading.Event) -> None:
        """Run until it is stopped or switched off."""
        while not ending.is_set() and not self._machine.is_off:
            now = time.monotonic()
            self._step()
            due_s = min(max(STEP_S, self._machine.next_deadline - now), OFF_S)
            self._executor.spin_once(timeout_sec=due_s)
            self._double()
        self._executor.shutdown()
        for server in self._servers:
            server.destroy()
        self._node.destroy_node()
        self._context.try_shutdown()

    def _serve(self) -> Any:
        from rclpy.action import ActionServer
        from rclpy.callback_groups import ReentrantCallbackGroup

        return ActionServer(
            self._node,
            self._type,
            self._action,
            execute_callback=self._execute,
            goal_callback=self._ask,
            handle_accepted_callback=self._begin,
            cancel_callback=self._cancel,
            callback_group=ReentrantCallbackGroup(),  # a call that waits for its end holds up no other
        )

    def _double(self) -> None:
        if self._machine.is_doubled and len(self._servers) == 1:
            self._servers.append(self._serve())
        elif not self._machine.is_doubled and len(self._servers) == 2:
            self._servers.pop().destroy()

    def _step(self, *events: GoalRequest | CancelRequest) -> None:
        for message in self._machine.step(time.monotonic(), events):
            if isinstance(message, Measurement):
                self._publish(message)
            elif isinstance(message, GoalAnswer):
                self._answers[message.id].set_result(message.accepted)
            elif isinstance(message, CancelDecision):
                self._cancels[message.id].set_result(message.accepted)
            else:
                self._results[message.id].set_result(message)

    async def _ask(self, goal: Any) -> Any:
        from rclpy.action import GoalResponse
        from rclpy.task import Future

        self._count += 1
        id = str(self._count)
        self._answers[id], self._results[id] = Future(), Future()
        self._step(GoalRequest(id=id, goal=self._protocol.goal(goal)))
        accepted = await self._answers.pop(id)
        self._accepted = id  # rclpy makes its handle before it does anything else
        return GoalResponse.ACCEPT if accepted else GoalResponse.REJECT

    def _begin(self, handle: Any) -> None:
        self._handles[bytes(handle.goal_id.uuid).hex()] = self._accepted
        handle.execute()

    async def _execute(self, handle: Any) -> Any:
        end: GoalResult = await self._results[self._id_of(handle)]
        result = self._type.Result()
        self._protocol.result(result, end)
        ways = {Status.SUCCEEDED: handle.succeed, Status.CANCELED: handle.canceled}
        if end.status is Status.CANCELED and not handle.is_cancel_requested:
            handle.abort()  # an action server cannot end an uncancelled goal as cancelled
        else:
            ways.get(end.status, handle.abort)()
        return result

    async def _cancel(self, handle: Any) -> Any:
        from rclpy.action import CancelResponse
        from rclpy.task import Future

        id = self._id_of(handle)
        self._cancels[id] = Future()
        self._step(CancelRequest(id=id))
        accepted = await self._cancels.pop(id)
        return CancelResponse.ACCEPT if accepted else CancelResponse.REJECT

    def _id_of(self, handle: Any) -> str:
        return str(self._handles[bytes(handle.goal_id.uuid).hex()])


def joint_sensors(topic: str) -> Callable[[Any], Callable[[Measurement], None]]:
    """The factory of a publisher of joint states on `topic`."""
    return partial(_joint_sensors, topic)


def _joint_sensors(topic: str, node: Any) -> Callable[[Measurement], None]:
    from sensor_msgs.msg import JointState

    publisher = node.create_publisher(JointState, topic, 10)

    def publish(measurement: Any) -> None:
        message = JointState(name=list(measurement.names), position=list(measurement.positions))
        message.header.stamp.sec, message.header.stamp.nanosec = measurement.stamp
        publisher.publish(message)

    return publish
