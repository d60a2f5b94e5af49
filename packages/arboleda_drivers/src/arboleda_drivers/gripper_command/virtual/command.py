"""The command `arboleda virtual gripper`."""

from __future__ import annotations

from functools import partial
from typing import Annotated

import typer

from arboleda.extension import Phrase, say
from arboleda_drivers.ros_action.virtual.options import JointStates, Lan, Rate
from arboleda_drivers.virtual.serving import FaultNames, FaultPort, adding, serve, with_faults

from .machine import FAULTS

SIZES = Phrase("cli.virtual.sizes", "the part is between 0 and --open, and the speed is more than 0")
OF_SIZES = "--open, --part, --speed"
HELP = with_faults(
    "Play a gripper of ros2_control with a part between its fingers: the action GripperCommand, or "
    "ParallelGripperCommand with --parallel, and joint states. It is a plain action server of rclpy, and "
    "stands in for ros2_control. Any client of that action can use it.",
    FAULTS,
)


def run(
    action: Annotated[str, typer.Option(help="The action's name.")] = "gripper_controller/gripper_cmd",
    parallel: Annotated[bool, typer.Option("--parallel", help="Serve ParallelGripperCommand.")] = False,
    joint_states: JointStates = "joint_states",
    joint: Annotated[str, typer.Option(help="The name of its joint.")] = "finger_joint",
    opened: Annotated[
        float, typer.Option("--open", help="Its joint's position when open; closed it is 0.")
    ] = 0.085,
    part: Annotated[float, typer.Option(help="Its joint's position when it has the part.")] = 0.04,
    speed: Annotated[float, typer.Option(help="Speed of its joint, m/s or rad/s.")] = 0.1,
    rate: Rate = 50.0,
    lan: Lan = False,
    fault: FaultNames = None,
    fault_port: FaultPort = 4718,
) -> None:
    if opened == 0 or not 0 < part / opened < 1 or speed <= 0:
        raise typer.BadParameter(say(SIZES()), param_hint=OF_SIZES)
    from .server import controller  # it loads rclpy

    make = partial(
        controller,
        action=action,
        parallel=parallel,
        joint_states=joint_states,
        joint=joint,
        opened=opened,
        part=part,
        speed=speed,
        rate=rate,
        lan=lan,
    )
    serve(make, FAULTS, fault, fault_port)


add_to = adding("gripper", HELP, run)
