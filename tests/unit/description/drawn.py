"""A URDF as urdf_parser_py reads it, and where its links are: plain 4 x 4 matrices, row by row."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from functools import reduce
from typing import Any

from urdf_parser_py.urdf import Robot
from urdf_parser_py.xml_reflection import core

Matrix = tuple[tuple[float, ...], ...]
Point = tuple[float, float, float]


def read(text: str) -> Robot:
    """The robot; ValueError for a tag or attribute that URDF does not know."""
    unknown: list[str] = []
    before, core.on_error = core.on_error, unknown.append
    try:
        robot = Robot.from_xml_string(text.encode())
    finally:
        core.on_error = before
    if unknown:
        raise ValueError("; ".join(unknown))
    return robot


def moving(robot: Robot) -> list[Any]:
    """Its joints that move, from the root outwards."""
    return [joint for joint in robot.joints if joint.type != "fixed"]


def place(robot: Robot, link: str, q: Iterable[float] = ()) -> Matrix:
    """Where a link is in the root's frame, with the moving joints at `q`; zero where none is given."""
    given = dict(zip((joint.name for joint in moving(robot)), q, strict=False))
    chain = robot.get_chain(robot.get_root(), link, links=False)
    return product(*(_step(robot.joint_map[name], given) for name in chain))


def product(*matrices: Matrix) -> Matrix:
    """The matrix product, from left to right."""
    return reduce(_times, matrices, shifted(0, 0, 0))


def shifted(x: float, y: float, z: float) -> Matrix:
    return ((1, 0, 0, x), (0, 1, 0, y), (0, 0, 1, z), (0, 0, 0, 1))


def turned(axis: Iterable[float], angle: float) -> Matrix:
    """A turn about an axis of length 1 (Rodrigues)."""
    x, y, z = axis
    c, s, d = math.cos(angle), math.sin(angle), 1 - math.cos(angle)
    return (
        (c + x * x * d, x * y * d - z * s, x * z * d + y * s, 0),
        (y * x * d + z * s, c + y * y * d, y * z * d - x * s, 0),
        (z * x * d - y * s, z * y * d + x * s, c + z * z * d, 0),
        (0, 0, 0, 1),
    )


def pose(origin: Any) -> Matrix:
    """URDF's origin: roll about x, then pitch about y, then yaw about z, all of the parent."""
    roll, pitch, yaw = origin.rpy
    turns = (turned((0, 0, 1), yaw), turned((0, 1, 0), pitch), turned((1, 0, 0), roll))
    return product(shifted(*origin.xyz), *turns)


def at(matrix: Matrix, point: Point = (0, 0, 0)) -> Point:
    """A point of the matrix's frame, seen from outside."""
    x, y, z = (sum(a * b for a, b in zip(row, (*point, 1), strict=True)) for row in matrix[:3])
    return (x, y, z)


def inverse(matrix: Matrix) -> Matrix:
    """The way back of a turn and a shift."""
    turn = tuple((*(matrix[row][column] for row in range(3)), 0) for column in range(3))
    back = (*turn, (0, 0, 0, 1))
    return product(back, shifted(*(-value for value in at(matrix))))


def _times(a: Matrix, b: Matrix) -> Matrix:
    columns = tuple(zip(*b, strict=True))
    return tuple(
        tuple(sum(x * y for x, y in zip(row, column, strict=True)) for column in columns) for row in a
    )


def _step(joint: Any, given: Mapping[str, float]) -> Matrix:
    value = given.get(joint.name, 0.0)
    start = pose(joint.origin)
    if joint.type == "revolute":
        return product(start, turned(joint.axis, value))
    if joint.type == "prismatic":
        return product(start, shifted(*(value * part for part in joint.axis)))
    return start
