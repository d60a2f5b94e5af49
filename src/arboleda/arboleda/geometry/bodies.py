"""A URDF reduced to its drawing: nested links, their joints and primitive shapes, as plain data.

A link with a mesh has stand-ins: its primitive shapes for collisions, else tubes between its joints.

A link is {link, xyz, rpy, moves, shapes, children}: `xyz` (m) and `rpy` (rad) lead from the parent to its
joint, `moves` is None or {type, axis, index}: which of the robot's joints, counted from the root outwards,
moves it. A shape is {kind, size, xyz, rpy, color}: `size` is [x, y, z] of a box, [radius, length] of a
cylinder about z, [radius] of a sphere; `color` is [r, g, b] from 0 to 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from . import stand_in

Body = dict[str, Any]
TOOL = "tool0"
GREY = [0.6, 0.6, 0.6]
ORIGIN = {"xyz": [0.0, 0.0, 0.0], "rpy": [0.0, 0.0, 0.0]}
MOVING = ("revolute", "continuous", "prismatic")
SIZES: dict[str, Callable[[Element], list[float]]] = {
    "box": lambda tag: _numbers(tag.get("size", "")),
    "cylinder": lambda tag: [float(tag.get(key, "")) for key in ("radius", "length")],
    "sphere": lambda tag: [float(tag.get("radius", ""))],
}


def read(text: str) -> Body:
    """The root link of a URDF; ValueError if the URDF is not one tree of links with primitive shapes."""
    try:
        return _BodyReader(ElementTree.fromstring(text)).body()
    except ElementTree.ParseError as error:
        raise ValueError(f"not XML: {error}") from error


def links(body: Body) -> Iterator[Body]:
    """A body's links, each before its children."""
    yield body
    for child in body["children"]:
        yield from links(child)


def tip(body: Body) -> str:
    """The link of the tool: `tool0` after its prefix, else the last link of the longest chain."""
    tools = [link["link"] for link in links(body) if link["link"].endswith(TOOL)]
    return min(tools, key=len) if tools else max(_chains(body, 0))[1]


def tool_chain(body: Body) -> list[Body]:
    """The links from the root to the tool."""
    return _chain_to(body, tip(body))


def _chain_to(body: Body, end: str) -> list[Body]:
    if body["link"] == end:
        return [body]
    chains = (_chain_to(child, end) for child in body["children"])
    return next(([body, *chain] for chain in chains if chain), [])


def _chains(body: Body, depth: int) -> Iterator[tuple[int, str]]:
    yield depth, body["link"]
    for child in body["children"]:
        yield from _chains(child, depth + 1)


class _BodyReader:
    def __init__(self, robot: Element) -> None:
        self._links = {link.get("name", ""): link for link in robot.findall("link")}
        self._joints = robot.findall("joint")
        self._colors = {each.get("name", ""): _color(each) for each in robot.findall("material")}
        self._moving = 0

    def body(self) -> Body:
        children = {_end(joint, "child") for joint in self._joints}
        roots = [name for name in self._links if name not in children]
        if len(roots) != 1:
            raise ValueError(
                f"a robot is one tree of links; this one has the roots {', '.join(roots) or 'none'}"
            )
        return self._link(roots[0], ORIGIN, None)

    def _link(self, name: str, origin: dict[str, Any], moves: dict[str, Any] | None) -> Body:
        if name not in self._links:
            raise ValueError(f"a joint leads to the link {name}, which is not there")
        joints = [joint for joint in self._joints if _end(joint, "parent") == name]
        shapes = self._shapes(self._links[name], joints)
        children = [self._link(_end(joint, "child"), _origin(joint), self._moves(joint)) for joint in joints]
        return {"link": name, **origin, "moves": moves, "shapes": shapes, "children": children}

    def _moves(self, joint: Element) -> dict[str, Any] | None:
        kind = joint.get("type", "")
        if kind not in MOVING:
            return None
        axis = joint.find("axis")
        index, self._moving = self._moving, self._moving + 1
        along = _unit(_numbers(axis.get("xyz", ""))) if axis is not None else [1.0, 0.0, 0.0]
        return {"type": "slide" if kind == "prismatic" else "turn", "axis": along, "index": index}

    def _shapes(self, link: Element, joints: list[Element]) -> list[dict[str, Any]]:
        visuals = link.findall("visual")
        plain = [visual for visual in visuals if not _is_mesh(visual)]
        shapes = [self._shape(visual) for visual in plain]
        if len(plain) == len(visuals):
            return shapes
        hits = [self._shape(each) for each in link.findall("collision") if not _is_mesh(each)]
        rails = [rail for joint in joints if (rail := self._rail(joint)) is not None]
        tubes = stand_in.shapes((_origin(joint)["xyz"] for joint in joints), rails)
        return shapes + (hits or [{**tube, "color": GREY} for tube in tubes])

    def _rail(self, joint: Element) -> tuple[list[float], list[float]] | None:
        """The rail of a sliding joint that has ends."""
        limit, axis = joint.find("limit"), joint.find("axis")
        if joint.get("type") != "prismatic" or limit is None or axis is None:
            return None
        lower, upper = float(limit.get("lower", "0")), float(limit.get("upper", "0"))
        origin = _origin(joint)
        return stand_in.rail(origin["xyz"], origin["rpy"], _unit(_numbers(axis.get("xyz", ""))), lower, upper)

    def _shape(self, visual: Element) -> dict[str, Any]:
        primitive = _geometry(visual)
        if primitive is None or primitive.tag not in SIZES:
            what = primitive.tag if primitive is not None else "nothing"
            raise ValueError(f"a shape is one of {', '.join(SIZES)}, not {what}")
        return {
            "kind": primitive.tag,
            "size": SIZES[primitive.tag](primitive),
            **_origin(visual),
            "color": self._color_of(visual),
        }

    def _color_of(self, visual: Element) -> list[float]:
        material = visual.find("material")
        if material is None:
            return GREY
        own = _color(material)
        return own or self._colors.get(material.get("name", "")) or GREY


def _geometry(visual: Element) -> Element | None:
    geometry = visual.find("geometry")
    return geometry[0] if geometry is not None and len(geometry) else None


def _is_mesh(visual: Element) -> bool:
    primitive = _geometry(visual)
    return primitive is not None and primitive.tag == "mesh"


def _unit(axis: list[float]) -> list[float]:
    length = math.hypot(*axis)
    if not length:
        raise ValueError("an axis must point somewhere, not 0 0 0")
    return [value / length for value in axis]


def _end(joint: Element, which: str) -> str:
    tag = joint.find(which)
    return tag.get("link", "") if tag is not None else ""


def _origin(element: Element) -> dict[str, Any]:
    tag = element.find("origin")
    if tag is None:
        return ORIGIN
    return {key: _numbers(tag.get(key, "0 0 0")) for key in ("xyz", "rpy")}


def _color(material: Element) -> list[float] | None:
    tag = material.find("color")
    return _numbers(tag.get("rgba", ""))[:3] if tag is not None else None


def _numbers(text: str) -> list[float]:
    return [float(number) for number in text.split()]
