"""URDF of a model of the plant's own: from the link `base_link` on the floor to the link `tool0`."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from xml.etree.ElementTree import Element, SubElement, tostring

from arboleda.geometry import bodies, kinematics, stand_in
from arboleda.kinds.joints import Joint

from .robot_models import millimetres
from .shapes import OffsetShape
from .urdf_axis import Axis
from .urdf_file import Chain

ROOT, TOOL = "base_link", "tool0"
UPRIGHT = 0.999  # how vertical a sliding joint is that lifts


def drawing(chain: Chain, mount: OffsetShape | None = None, tool: OffsetShape | None = None) -> str:
    """The URDF of the chain from its mounting to its tool point; a chain without any shape gets stand-ins.

    A link of the file that is called `base_link` or `tool0`, but stands elsewhere, is renamed, as
    `tool0_of_model`.
    """
    robot = chain.robot
    names: dict[str, str] = {}
    if mount is not None or chain.base != ROOT:
        names[ROOT] = _free(robot, "link", f"{ROOT}_of_model")
    if tool is not None or chain.tip != TOOL:
        names[TOOL] = _free(robot, "link", f"{TOOL}_of_model")
    _rename(robot, names)
    if robot.find("link/visual") is None:
        _add_stand_ins(robot, {axis.name: axis for axis in chain.axes})
    if ROOT in names:
        _fix(robot, ROOT, (ROOT, names.get(chain.base, chain.base)), mount)
    if TOOL in names:
        _fix(robot, TOOL, (names.get(chain.tip, chain.tip), TOOL), tool)
    return tostring(robot, encoding="unicode")


def lifts(urdf: str, joints: Sequence[Joint]) -> list[int]:
    """The direction in which each joint lifts the tool: -1 for smaller values, 1 for greater ones, else 0."""
    body = bodies.read(urdf)
    frames = kinematics.place(body, (0.0,) * len(joints))
    directions = [0] * len(joints)
    level = True  # every joint that turned so far turns about a vertical axis
    for link in bodies.tool_chain(body):
        moves = link["moves"]
        if moves is None:
            continue
        up = kinematics.upright(frames[link["link"]], moves["axis"])
        if moves["type"] == "turn":
            level = level and abs(up) > UPRIGHT
        elif level and abs(up) > UPRIGHT:
            directions[moves["index"]] = 1 if up > 0 else -1
    return directions


def _free(robot: Element, kind: str, name: str) -> str:
    """The name, or a similar one that no other link or joint has."""
    taken = {each.get("name") for each in robot.findall(kind)}
    while name in taken:
        name += "_"
    return name


def _rename(robot: Element, names: dict[str, str]) -> None:
    for link in robot.findall("link"):
        link.set("name", names.get(link.get("name", ""), link.get("name", "")))
    for end in (*robot.findall("joint/parent"), *robot.findall("joint/child")):
        end.set("link", names.get(end.get("link", ""), end.get("link", "")))


def _fix(robot: Element, new: str, ends: tuple[str, str], offset: OffsetShape | None) -> None:
    """Add the link `new`, and a fixed joint between the two links `ends`."""
    offset = offset or OffsetShape()
    xyz, rpy = map(millimetres, offset.xyz_mm), map(math.radians, offset.rpy_deg)
    SubElement(robot, "link", {"name": new})
    joint = SubElement(robot, "joint", {"name": _free(robot, "joint", f"{new}_joint"), "type": "fixed"})
    SubElement(joint, "parent", {"link": ends[0]})
    SubElement(joint, "child", {"link": ends[1]})
    SubElement(joint, "origin", {"xyz": in_words(xyz), "rpy": in_words(rpy)})


def _add_stand_ins(robot: Element, axes: Mapping[str, Axis]) -> None:
    for link in robot.findall("link"):
        joints = [joint for joint in robot.findall("joint") if _parent(joint) == link.get("name")]
        rails = [
            _rail(joint, axes[joint.get("name", "")])
            for joint in joints
            if joint.get("type") == "prismatic" and joint.get("name", "") in axes
        ]
        for shape in stand_in.shapes(map(_xyz, joints), rails):
            visual = SubElement(link, "visual")
            SubElement(visual, "origin", {"xyz": in_words(shape["xyz"]), "rpy": in_words(shape["rpy"])})
            sizes = dict(zip(("radius", "length"), map(repr, shape["size"]), strict=False))
            SubElement(SubElement(visual, "geometry"), shape["kind"], sizes)


def _parent(joint: Element) -> str | None:
    parent = joint.find("parent")
    return parent.get("link") if parent is not None else None


def _xyz(joint: Element) -> list[float]:
    return _numbers(joint.find("origin"), "xyz", "0 0 0")


def _rail(joint: Element, axis: Axis) -> tuple[list[float], list[float]]:
    """The two ends of the path along which a sliding joint moves the links that it carries."""
    turned = _numbers(joint.find("origin"), "rpy", "0 0 0")
    along = _numbers(joint.find("axis"), "xyz", "1 0 0")
    length = math.hypot(*along) or 1.0
    return stand_in.rail(_xyz(joint), turned, [each / length for each in along], axis.lower, axis.upper)


def _numbers(element: Element | None, key: str, default: str) -> list[float]:
    return [float(value) for value in (default if element is None else element.get(key, default)).split()]


def in_words(values: Iterable[float]) -> str:
    """The numbers as an attribute of XML has them."""
    return " ".join(f"{value:.10g}" for value in values)
