"""The command `arboleda virtual trajectory`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..ros_action.command import JointStates, Lan, Rate, controller
from ..serving import FaultNames, FaultPort, serve, with_faults
from .machine import FAULTS

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
        raise typer.BadParameter("it needs one or several names, each once", param_hint="--joints")
    make = controller("trajectory")
    serve(
        lambda faults: make(
            faults, action=action, joint_states=joint_states, joints=names, rate=rate, lan=lan
        ),
        FAULTS,
        fault,
        fault_port,
    )
