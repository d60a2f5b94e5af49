"""Table of the nodes that a launch starts: one plain row for each, made from the plant."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from arboleda.drivers import Robot
from arboleda.model.plant_model import Link, PlantModel
from arboleda.plant_file.urdf import root_link

from .choice import Choice
from .row import Row, Value

WORLD = "world"
RVIZ_CONFIG = "rviz/plant.rviz"  # in the share folder of this package


def table(plant: PlantModel, choice: Choice, *, urdf: Callable[[str], str], share: str) -> list[Row]:
    """The nodes of a plant; `urdf` describes a robot by its name, `share` is this package's folder."""
    robots = [robot for robot in plant.robots.values() if robot.drawn() is not None]
    rows = [row for robot in robots for row in _shown(robot, urdf(robot.name))] if choice.describe else []
    rows += _plant(choice, plant)
    if choice.rviz:
        rows.append(Row(package="rviz2", executable="rviz2", arguments=("-d", f"{share}/{RVIZ_CONFIG}")))
    return rows


def namespace(robot: Robot) -> str:
    """The namespace of a robot's joint states and description: the twin of an arm, the name of a mobile."""
    return robot.joint_states.twin


def _shown(robot: Robot, urdf: str) -> list[Row]:
    """The nodes that draw a robot; one publishes its joints if nobody else does."""
    described = {"robot_description": urdf}
    rows = [_named("robot_state_publisher", robot, parameters=described), _placed(robot)]
    if robot.link is Link.NONE:
        rows.append(_named("joint_state_publisher", robot))
    return rows


def _named(package: str, robot: Robot, **more: Any) -> Row:
    """The executable of the same name as its package, in the robot's namespace."""
    return Row(package=package, executable=package, namespace=namespace(robot), **more)


def _placed(robot: Robot) -> Row:
    drawing: dict[str, Any] = robot.drawn() or {}
    x, y, yaw = (str(value) for value in drawing["at"])
    frames = ("--frame-id", WORLD, "--child-frame-id", root_link(robot))
    return Row(
        package="tf2_ros",
        executable="static_transform_publisher",
        namespace=namespace(robot),
        arguments=("--x", x, "--y", y, "--z", "0.0", "--yaw", yaw, *frames),
    )


def _plant(choice: Choice, plant: PlantModel) -> list[Row]:
    """The executables of arboleda_ros, as the plant is put together with these arguments."""
    rows, instead = [], choice.sim and bool(plant.driven)  # of drivers
    boards = plant.has_boards or instead
    shared: dict[str, Value] = {"virtual": True} if instead else {}
    if boards and choice.sim:
        rows.append(_part("virtual_devices", choice, broker=choice.broker, **shared))
    if boards:
        rows.append(_part("mqtt_bridge", choice, broker=choice.broker_address, **shared))
    if choice.orchestrator:
        page: dict[str, Value] = {"dashboard": choice.dashboard, "dashboard_port": choice.port}
        broker: dict[str, Value] = {"broker": choice.broker_address} if boards or choice.names_broker else {}
        rows.append(_part("orchestrator", choice, **broker, **page, **shared))
    return rows


def _part(executable: str, choice: Choice, **more: Value) -> Row:
    common: dict[str, Value] = {
        "plant": choice.plant,
        "state_dir": choice.state_dir,
        "rate": choice.rate,
    }
    return Row(package="arboleda_ros", executable=executable, parameters={**common, **more}, required=True)
