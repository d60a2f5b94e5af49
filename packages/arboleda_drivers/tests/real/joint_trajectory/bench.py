"""An arm behind `follow_joint_trajectory`."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from arboleda.plant_file.loader import load
from arboleda.testing.drivers import Bench

from ..contract.mover import ARM_DEG, WORDS, Opened, app_of, arm
from ..ros_action.bench import PlayedServer

PATH_TOLERANCE = -4
GOALS = {tuple(map(float, deg)): word for deg, word in zip(ARM_DEG, WORDS, strict=True)}


class Arm:
    package = "control_msgs"
    action = "joint_trajectory_controller/follow_joint_trajectory"
    type_name = "FollowJointTrajectory"
    failure = "path_tolerance_violated"

    def __init__(self, joints: list[str]) -> None:
        self._joints, self._q = joints, (0.0,) * len(joints)

    def word(self, goal: Any) -> str:
        return GOALS[tuple(round(math.degrees(each), 1) for each in goal.trajectory.points[-1].positions)]

    def go(self, goal: Any) -> None:
        self._q = tuple(goal.trajectory.points[-1].positions)

    def give_up(self, result: Any) -> None:
        result.error_code = PATH_TOLERANCE

    def publishers(self, node: Any) -> None:
        from sensor_msgs.msg import JointState

        self._states = node.create_publisher(JointState, "joint_states", 10)

    def speak(self, stamp: Any) -> None:
        from sensor_msgs.msg import JointState

        state = JointState(name=self._joints, position=list(self._q))
        state.header.stamp = stamp
        self._states.publish(state)


def _open(folder: Path, state: Path) -> Opened:
    app = app_of(folder, state, arm("{follow_joint_trajectory: {speed_percent: 100}}"), "arm")
    joints = [joint.name for joint in load(folder / "plant.yaml").robots["arm"].joints]
    return app, lambda app: PlayedServer(Arm(joints))


BENCH = Bench(open=_open)
