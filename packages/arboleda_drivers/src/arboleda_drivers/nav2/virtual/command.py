"""The command `arboleda virtual nav2`."""

from __future__ import annotations

import math
from functools import partial
from typing import Annotated

import typer

from arboleda_drivers.nav2.pose import Pose
from arboleda_drivers.ros_action.virtual.options import Lan, Rate
from arboleda_drivers.virtual.serving import FaultNames, FaultPort, adding, serve, with_faults

from .machine import FAULTS

HELP = with_faults(
    "Play a mobile base that Nav2 drives: the action NavigateToPose, or FollowWaypoints with --waypoints, "
    "odometry and the poses of amcl. It is a plain action server of rclpy, and stands in for Nav2: it drives "
    "straight, and knows no obstacles. Any client of that action can use it.",
    FAULTS,
)


def run(
    waypoints: Annotated[bool, typer.Option("--waypoints", help="Serve FollowWaypoints.")] = False,
    action: Annotated[
        str | None, typer.Option(help="The action's name; navigate_to_pose, or follow_waypoints.")
    ] = None,
    odometry: Annotated[str, typer.Option(help="The topic of its odometry.")] = "odom",
    localisation: Annotated[str, typer.Option(help="The topic of its poses on the map.")] = "amcl_pose",
    frame: Annotated[str, typer.Option(help="The map's frame.")] = "map",
    x: Annotated[float, typer.Option(help="Where it begins on the map, m.")] = 0.0,
    y: Annotated[float, typer.Option(help="Where it begins on the map, m.")] = 0.0,
    yaw: Annotated[float, typer.Option(help="Its direction there, degrees.")] = 0.0,
    speed: Annotated[float, typer.Option(min=0.01, help="Speed, m/s.")] = 0.5,
    rate: Rate = 50.0,
    lan: Lan = False,
    fault: FaultNames = None,
    fault_port: FaultPort = 4719,
) -> None:
    from .server import controller  # it loads rclpy

    make = partial(
        controller,
        action=action or ("follow_waypoints" if waypoints else "navigate_to_pose"),
        waypoints=waypoints,
        odometry=odometry,
        localisation=localisation,
        frame=frame,
        start=Pose(x, y, math.radians(yaw)),
        speed=speed,
        rate=rate,
        lan=lan,
    )
    serve(make, FAULTS, fault, fault_port)


add_to = adding("nav2", HELP, run)
