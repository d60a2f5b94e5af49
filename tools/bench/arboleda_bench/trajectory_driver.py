"""A goal of an arm over the driver follow_joint_trajectory until it is done, against a bare client of rclpy.

The action server is a plain one of rclpy in a process of its own, which has reached every goal at once and
publishes joint states 200 times a second. Ours is `send` of the driver until its report of done; the floor
is an `ActionClient` of rclpy that sends the same goal, waits for its result, and then for a joint state that
came later and is at the goal: it proves as much. In turns, over one server.
"""

from __future__ import annotations

import math
import threading
import time
from typing import Any

from arboleda.drivers import MotionState, MoveJoints
from arboleda.extension import ArboledaError
from arboleda.kinds.arm import Arm
from arboleda.testing.plants import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda_drivers.joint_trajectory.settings import Settings

from .reports import Reports
from .result import Aim, Figure, Result, percentile
from .scene import Scene

PATIENCE_S = 20.0
AIM = Aim(most=1.5)
NAMES = tuple(f"joint{number}" for number in range(1, 7))


def run(scene: Scene) -> Result:
    try:
        import control_msgs.action  # noqa: F401
    except ImportError as error:
        raise ArboledaError(
            f"control_msgs cannot be imported ({error}); source a ROS 2 that has it"
        ) from error
    times = 100 if scene.quick else 1000
    scene.say("starting")
    scene.python("arboleda_bench.trajectory_server")
    arm = StorageLayout(shipped("sis_c").cells[0]).arm
    ours, floor = Driven(arm), Bare()
    try:
        scene.say("goals in turns")
        pairs = [[1000 * each.go(goal_of(arm, turn)) for each in (ours, floor)] for turn in range(times)]
    finally:
        ours.close()
        floor.close()
    note = f"{times} of each in turns, over one server; joint states 5 ms apart"
    return Result(figures=[_figure(pairs, percent) for percent in (50, 99)], notes=(note,))


def goal_of(arm: Arm, turn: int) -> tuple[float, ...]:
    """One of several goals; never the same twice in a row."""
    return arm.motion.quantised((math.radians(1 + turn % 50), 0.0, 0.0, 0.0, 0.0, 0.0))


def _figure(pairs: list[list[float]], percent: int) -> Figure:
    ours, floor = (percentile([pair[at] for pair in pairs], percent) for at in range(2))
    name = f"a goal until it is done, p{percent}"
    return Figure(name=name, unit="ms", ours=ours, floor=floor, aim=AIM if percent == 50 else None)


class Driven:
    """The driver, as a plant uses it."""

    def __init__(self, arm: Arm) -> None:
        from arboleda_drivers.joint_trajectory.adapter import FollowJointTrajectory

        self._arm, self._number = arm, 0
        self._reports = Reports(PATIENCE_S)
        self._driver = FollowJointTrajectory(Settings(joints=NAMES))
        self._driver.start([arm], self._reports.hear, time.monotonic)
        self._reports.until(lambda report: report.state is MotionState.STOPPED)

    def go(self, q: tuple[float, ...]) -> float:
        self._number += 1
        id = f"c{self._number}"
        began = time.perf_counter()
        self._driver.send(MoveJoints(id=id, robot=self._arm.name, q=q))
        self._reports.until(lambda report: report.done == id)
        return time.perf_counter() - began

    def close(self) -> None:
        self._driver.stop()


class Bare:
    """Bare client: the code that one writes with rclpy and nothing else."""

    def __init__(self) -> None:
        from control_msgs.action import FollowJointTrajectory
        from rclpy.action import ActionClient
        from rclpy.context import Context
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.node import Node
        from rclpy.qos import qos_profile_sensor_data
        from sensor_msgs.msg import JointState

        from .trajectory_server import ACTION

        self._context = Context()
        self._context.init()
        self._node = Node("bare_client", context=self._context)
        self._type = FollowJointTrajectory
        self._client = ActionClient(self._node, FollowJointTrajectory, ACTION)
        self._node.create_subscription(JointState, "joint_states", self._see, qos_profile_sensor_data)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._goal: tuple[float, ...] = ()
        self._has_result, self._done = False, threading.Event()
        self._thread = threading.Thread(target=self._executor.spin, name="bare", daemon=True)
        self._thread.start()
        if not self._client.wait_for_server(timeout_sec=PATIENCE_S):
            raise ArboledaError("the action server is not found")

    def go(self, q: tuple[float, ...]) -> float:
        from builtin_interfaces.msg import Duration
        from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

        self._goal, self._has_result = q, False
        self._done.clear()
        point = JointTrajectoryPoint(positions=list(q), time_from_start=Duration(sec=1))
        trajectory = JointTrajectory(joint_names=list(NAMES), points=[point])
        began = time.perf_counter()
        sent = self._client.send_goal_async(self._type.Goal(trajectory=trajectory))
        sent.add_done_callback(self._accepted)
        if not self._done.wait(PATIENCE_S):
            raise ArboledaError("the bare client's goal has no end")
        return time.perf_counter() - began

    def close(self) -> None:
        self._executor.shutdown()
        self._thread.join()
        self._node.destroy_node()
        self._context.try_shutdown()

    def _accepted(self, sent: Any) -> None:
        sent.result().get_result_async().add_done_callback(self._ended)

    def _ended(self, result: Any) -> None:
        self._has_result = True

    def _see(self, state: Any) -> None:
        at = dict(zip(state.name, state.position, strict=True))
        if self._has_result and all(at[name] == goal for name, goal in zip(NAMES, self._goal, strict=True)):
            self._done.set()
