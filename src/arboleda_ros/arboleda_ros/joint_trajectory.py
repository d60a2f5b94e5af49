"""The driver `follow_joint_trajectory`: an action client, a subscription and a timer around its machine.

Plant files are read without rclpy and control_msgs: where they are missing, the start says so.
"""

from __future__ import annotations

import os
import threading
import zlib
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from typing import Any

from arboleda.drivers.joint_trajectory.machine import (
    Answered,
    Asked,
    CancelAll,
    CancelAnswered,
    Ended,
    Event,
    Found,
    JointsSeen,
    Machine,
    Message,
    SendGoal,
    Status,
    Unsent,
)
from arboleda.drivers.joint_trajectory.settings import Settings
from arboleda.drivers.port import Clock, DriverError, Hear, NotSent, driver
from arboleda.model.commands import Command
from arboleda.model.messages import Report
from arboleda.model.plant_model import Robot

with suppress(ImportError):
    # Drivers start in threads of their own, and two threads that import rclpy at once both fail.
    import rclpy.action  # noqa: F401

    import arboleda_ros.link  # noqa: F401

LOOK_S = 0.1  # between two looks at which servers there are
REJECTED = 1  # CancelGoal: the server goes on with what it does


@driver("follow_joint_trajectory", settings=Settings)
class FollowJointTrajectory:
    """One arm behind a joint trajectory controller. All of ROS 2 is done in one thread of its link."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._lock = threading.Lock()  # around the machine and what it reports
        self._link: Any = None
        self._actions: Any = None

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        self._hear, self._clock = hear, clock
        self._machine = Machine(devices, self._settings)
        self._types = _types()
        from .link import connect

        self._link = connect(lan=self._settings.lan)
        self._join(self._link.node(f"{devices[0].name}_driver"))
        self._link.start()

    def send(self, command: Command) -> None:
        for message in self._step(Asked(command=command)):
            if isinstance(message, Unsent):
                raise NotSent(message.why)

    def stop(self) -> None:
        if self._link is not None:
            self._link.close()

    def _join(self, node: Any) -> None:
        from action_msgs.srv import CancelGoal
        from rclpy.action import ActionClient
        from rclpy.clock import Clock as RosClock
        from rclpy.clock import ClockType
        from sensor_msgs.msg import JointState

        from .qos import SENSOR

        action = self._settings.action
        self._node = node
        self._actions = ActionClient(node, self._types.FollowJointTrajectory, action)
        self._cancels = node.create_client(CancelGoal, f"{action}/_action/cancel_goal")
        node.create_subscription(JointState, self._settings.joint_states, self._see, SENSOR)
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
        return messages

    def _later(self, what: Callable[[], None]) -> None:
        """Have it done in the thread of ROS 2: an action client is not made for several."""
        self._node.executor.create_task(what)

    # What leaves.

    def _send_goal(self, message: SendGoal) -> None:
        from builtin_interfaces.msg import Duration
        from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

        seconds, rest_s = divmod(message.duration_s, 1)
        still = [0.0] * len(message.q)
        point = JointTrajectoryPoint(
            positions=list(message.q),
            velocities=still,
            accelerations=still,
            time_from_start=Duration(sec=int(seconds), nanosec=int(rest_s * 1e9)),
        )
        trajectory = JointTrajectory(joint_names=list(message.joints), points=[point])
        goal = self._types.FollowJointTrajectory.Goal(trajectory=trajectory)
        self._actions.send_goal_async(goal).add_done_callback(partial(self._answered, message.id))

    def _cancel_all(self) -> None:
        from action_msgs.srv import CancelGoal

        # A request without an id and a time means all goals, those of other clients among them.
        self._cancels.call_async(CancelGoal.Request()).add_done_callback(self._cancelled)

    # What comes back, in the thread of ROS 2.

    def _answered(self, id: str, future: Any) -> None:
        handle = future.result()
        self._step(Answered(id=id, accepted=handle.accepted))
        if handle.accepted:
            handle.get_result_async().add_done_callback(partial(self._ended, id))

    def _ended(self, id: str, future: Any) -> None:
        said = future.result()
        status = STATUSES.get(said.status, Status.UNKNOWN)
        self._step(Ended(id=id, status=status, error=said.result.error_code, text=said.result.error_string))

    def _cancelled(self, future: Any) -> None:
        self._step(CancelAnswered(refused=future.result().return_code == REJECTED))

    def _see(self, message: Any) -> None:
        stamp = message.header.stamp
        self._step(
            JointsSeen(
                names=tuple(message.name),
                positions=tuple(message.position),
                stamp=(stamp.sec, stamp.nanosec),
            )
        )

    def _look(self) -> None:
        """Each server publishes the states of its goals, by an endpoint of its own."""
        topic = self._node.resolve_topic_name(f"{self._settings.action}/_action/status")
        found = self._node.get_publishers_info_by_topic(topic)
        ready = bool(found) and self._actions.server_is_ready()
        servers = tuple(sorted(zlib.crc32(bytes(each.endpoint_gid)) for each in found)) if ready else ()
        self._step(Found(servers=servers))


STATUSES = {4: Status.SUCCEEDED, 5: Status.CANCELED, 6: Status.ABORTED}
"""The ends of a goal in action_msgs/msg/GoalStatus."""


def _types() -> Any:
    """The actions of control_msgs; DriverError, which says what to install, where they are not there."""
    try:
        from control_msgs import action
    except ImportError as error:
        distro = os.environ.get("ROS_DISTRO", "$ROS_DISTRO")
        raise DriverError(
            f"it needs the message package control_msgs, which cannot be imported here ({error}): "
            f"sudo apt install ros-{distro}-control-msgs, and source that ROS 2"
        ) from None
    return action
