"""Fingers behind an action that the plant file maps; nothing of the driver knows of grippers."""

from __future__ import annotations

from pathlib import Path

from arboleda.testing.drivers import Bench

from ..contract.mover import Opened, app_of
from ..gripper_command.bench import Fingers
from ..ros_action.bench import PlayedServer

PLANT = """
name: ros2_mapped
uses: [recipes.py]
kinds:
  fingers:
    facts: {width_mm: number}
    verbs:
      go:
        effect: motion
        with: {width_mm: [30.0, 50.0]}
        sets: {width_mm: $width_mm}
        at_most_s: 30
cells:
  shop:
    devices:
      jaw:
        kind: fingers
        driver:
          ros:
            namespace: gripper_controller
            verbs:
              go:
                action: gripper_cmd
                type: control_msgs/action/GripperCommand
                fields: {command.position: {value: $width_mm, scale: 1000}}
            facts:
              width_mm:
                {topic: /joint_states, type: sensor_msgs/msg/JointState, field: "position[0]", scale: 1000,
                 near: 1, silent_s: 1}
"""


def _open(folder: Path, state: Path) -> Opened:
    app = app_of(folder, state, PLANT, "jaw", ("width_mm=30.0", "width_mm=50.0"))
    return app, lambda app: PlayedServer(Fingers())


BENCH = Bench(open=_open, takes="arboleda_drivers.ros_mapping.heard_facts.ToldFacts.hear")
