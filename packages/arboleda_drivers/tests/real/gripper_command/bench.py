"""Fingers behind `gripper_command`, which are told widths: the word of a gripper that grips has no halt."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from arboleda.testing.drivers import Bench
from arboleda.testing.drivers.bench import OTHER, WORK

from ..contract.mover import Opened, app_of
from ..ros_action.bench import PlayedServer

OPENED = 0.08
WORDS = {0.03: WORK, 0.05: OTHER}
PLANT = """
name: ros2_control
uses: [recipes.py]
kinds:
  fingers:
    facts: {{width_mm: number}}
    verbs:
      go:
        effect: motion
        with: {{width_mm: [30.0, 50.0]}}
        sets: {{width_mm: $width_mm}}
        at_most_s: 30
cells:
  shop:
    devices:
      jaw:
        kind: fingers
        driver: {{gripper_command: {{type: {type}, open: 0.08, width_mm: 80}}}}
"""


class Fingers:
    package = "control_msgs"
    action = "gripper_controller/gripper_cmd"
    type_name = "GripperCommand"
    failure = "aborted"

    def __init__(self) -> None:
        self._position = OPENED

    def position(self, goal: Any) -> float:
        return float(goal.command.position)

    def word(self, goal: Any) -> str:
        return WORDS[round(self.position(goal), 4)]

    def go(self, goal: Any) -> None:
        self._position = self.position(goal)

    def give_up(self, result: Any) -> None:
        """It has no words for that."""

    def publishers(self, node: Any) -> None:
        from sensor_msgs.msg import JointState

        self._states = node.create_publisher(JointState, "joint_states", 10)

    def speak(self, stamp: Any) -> None:
        from sensor_msgs.msg import JointState

        state = JointState(name=["finger_joint"], position=[self._position])
        state.header.stamp = stamp
        self._states.publish(state)


class ParallelFingers(Fingers):
    type_name = "ParallelGripperCommand"

    def position(self, goal: Any) -> float:
        return float(goal.command.position[0])


def _open(type: str, body: Callable[[], Fingers], folder: Path, state: Path) -> Opened:
    app = app_of(folder, state, PLANT.format(type=type), "jaw", ("width_mm=30.0", "width_mm=50.0"))
    return app, lambda app: PlayedServer(body())


BENCH = Bench(open=partial(_open, "single", Fingers))
PARALLEL_BENCH = Bench(open=partial(_open, "parallel", ParallelFingers))
