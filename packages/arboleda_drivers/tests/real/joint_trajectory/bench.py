"""An arm behind `follow_joint_trajectory`."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

from contract.bench import OTHER, WORK, Bench, Device
from ros_action.bench import HOME, PlayedServer

from arboleda.plant_file.loader import load
from arboleda.runtime.build import App, Options, build

PATH_TOLERANCE = -4
GOALS = {(0.0,) * 6: HOME, (10.0, 20.0, -30.0, 0.0, 5.0, 0.0): WORK, (5.0, 0.0, 0.0, 0.0, 0.0, 0.0): OTHER}
PLANT = """
name: ros2_control
uses: [recipes.py]
cells:
  shop:
    devices:
      arm:
        kind: arm
        model: cr10a
        driver: {follow_joint_trajectory: {speed_percent: 100}}
    targets:
      home: {arm: {deg: [0, 0, 0, 0, 0, 0]}}
      a: {arm: {deg: [10, 20, -30, 0, 5, 0]}}
      b: {arm: {deg: [5, 0, 0, 0, 0, 0]}}
"""
RECIPES = """
from arboleda.recipes import recipe

@recipe("work")
def work_(cell):
    return cell.device("arm").go("a")

@recipe("other")
def other(cell):
    return cell.device("arm").go("b")
"""


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


def _open(folder: Path, state: Path) -> tuple[App, Callable[[App], Device]]:
    folder.mkdir()
    (folder / "plant.yaml").write_text(PLANT, "utf-8")
    (folder / "recipes.py").write_text(RECIPES, "utf-8")
    model = load(folder / "plant.yaml")
    joints = [joint.name for joint in model.robots["arm"].joints]
    app = build(model, ("orchestrator",), Options(state_dir=state))
    return app, lambda app: PlayedServer(Arm(joints))


BENCH = Bench(open=_open)
