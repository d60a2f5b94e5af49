"""Robots of a plant as URDF, each with its prefix, its limits and its speeds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import cast
from xml.etree.ElementTree import SubElement, fromstring, indent, tostring

from arboleda.kinds.arm import Arm
from arboleda.kinds.joints import Description, Jointed
from arboleda.kinds.mobile import Mobile
from arboleda.model.errors import ConfigError, StartError
from arboleda.model.plant_model import PlantModel, Robot
from arboleda_description.urdf import Limits, render

from .document import nearest, shown

NO_XACRO = (
    "a URDF is made with the library xacro, which is not installed here; type `pip install xacro`, "
    "or `sudo apt install ros-$ROS_DISTRO-xacro` where ROS 2 is"
)


def robot_urdf(plant: PlantModel, name: str) -> str:
    """The URDF of a robot, from `root_link` outwards.

    ConfigError for a robot that the plant does not have; StartError without xacro or a usable drawing.
    """
    robot = _named(plant, name)
    description = own_description(robot)
    if description is not None:
        return _described(description.urdf, prefix(robot), limits(robot))
    model = cast("Jointed | Mobile", robot).model
    try:
        return str(render(model, prefix=prefix(robot), limits=limits(robot)))
    except ModuleNotFoundError as error:
        raise StartError(NO_XACRO) from error
    except ValueError as error:
        raise StartError(f"the model {model} of {name} cannot be drawn: {error}") from error


def drawn_arm(robot: Robot) -> Arm | None:
    """The robot as an arm on the floor; None for one that is no arm, or is not drawn."""
    return cast(Arm, robot) if robot.joints and robot.drawn() else None


def own_description(robot: Robot) -> Description | None:
    """The URDF of a robot's model that is the plant's own; None where its model comes with Arboleda."""
    return cast(Jointed, robot).description if robot.joints else None


def prefix(robot: Robot) -> str:
    """The prefix of the names of a robot's links and joints, as in its `joint_states`."""
    return f"{robot.joint_states.twin}_"


def root_link(robot: Robot) -> str:
    """The link that stands in `world` at the arm's base, or at node 0 of the mobile robot's grid."""
    return prefix(robot) + ("base_link" if robot.joints else "grid_link")


def limits(robot: Robot) -> dict[str, Limits]:
    """The limits by joint name without prefix, in SI units; joints of a mobile robot end with its grid."""
    if robot.joints:
        return {joint.name: Limits(joint.lower, joint.upper, joint.speed) for joint in robot.joints}
    far, speed = robot.floor_grid.position(robot.floor_grid.size - 1), cast(Mobile, robot).speed
    return {f"{axis}_joint": Limits(0.0, end, speed) for axis, end in zip("xy", far, strict=True)}


def _described(urdf: str, prefix: str, limits: Mapping[str, Limits]) -> str:
    """The URDF of a model of the plant's own, with its prefix, and with ends for every joint that moves."""
    robot = fromstring(urdf)
    for named in (*robot.findall("link"), *robot.findall("joint")):
        named.set("name", prefix + named.get("name", ""))
    for end in (*robot.findall("joint/parent"), *robot.findall("joint/child")):
        end.set("link", prefix + end.get("link", ""))
    for joint in robot.findall("joint"):
        if narrowed := limits.get(joint.get("name", "").removeprefix(prefix)):
            limit = joint.find("limit")
            limit = SubElement(joint, "limit", {"effort": "0"}) if limit is None else limit
            joint.set("type", "revolute" if joint.get("type") == "continuous" else joint.get("type", ""))
            limit.attrib |= {key: repr(value) for key, value in narrowed._asdict().items()}
    indent(robot)
    return '<?xml version="1.0"?>\n' + tostring(robot, encoding="unicode") + "\n"


def _named(plant: PlantModel, name: str) -> Robot:
    robot = plant.robots.get(name)
    if robot is None:
        allowed = f"there are {', '.join(plant.robots)}{nearest(name, plant.robots)}"
        raise ConfigError((f"{shown(name)} is not a robot of the plant {plant.name}; {allowed}",))
    if robot.drawn() is None:
        raise ConfigError((f"{shown(name)} has no model, so there is no drawing of it",))
    return robot
