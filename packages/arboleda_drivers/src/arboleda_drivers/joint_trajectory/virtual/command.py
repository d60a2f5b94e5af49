"""The command `arboleda virtual trajectory`."""

from __future__ import annotations

from functools import partial
from typing import Annotated

import typer

from arboleda.extension import Phrase, say
from arboleda_drivers.ros_action.virtual.options import JointStates, Lan, Rate
from arboleda_drivers.virtual.serving import FaultNames, FaultPort, adding, serve, with_faults

from .machine import FAULTS

NAMES = Phrase("cli.virtual.names", "it needs one or several names, each once")
HELP = with_faults(
    "Play an arm behind a joint_trajectory_controller of ros2_control: the action FollowJointTrajectory and "
    "joint states. It is a plain action server of rclpy, and stands in for ros2_control. Any client of that "
    "action can use it.",
    FAULTS,
)


def run(
    action: Annotated[
        str, typer.Option(help="The action's name.")
    ] = "joint_trajectory_controller/follow_joint_trajectory",
    joint_states: JointStates = "joint_states",
    joints: Annotated[
        str, typer.Option(help="Names of its joints, with commas.")
    ] = "joint1,joint2,joint3,joint4,joint5,joint6",
    rate: Rate = 50.0,
    lan: Lan = False,
    fault: FaultNames = None,
    fault_port: FaultPort = 4717,
) -> None:
    names = tuple(each.strip() for each in joints.split(",") if each.strip())
    if not names or len(set(names)) < len(names):
        raise typer.BadParameter(say(NAMES()), param_hint="--joints")
    from .server import controller  # it loads rclpy

    make = partial(controller, action=action, joint_states=joint_states, joints=names, rate=rate, lan=lan)
    serve(make, FAULTS, fault, fault_port)


add_to = adding("trajectory", HELP, run)
