"""Positions of the links of a body: plain 4 x 4 matrices, row by row."""

from __future__ import annotations

import math
from collections.abc import Sequence

from .bodies import Body, links, tip

Matrix = tuple[tuple[float, ...], ...]
Point = tuple[float, float, float]


def place(body: Body, q: Sequence[float], base: Matrix | None = None) -> dict[str, Matrix]:
    """The frame of every link, in the frame in which `base` is; `q` in rad and m, in the order of joints."""
    frames: dict[str, Matrix] = {}
    _place(body, q, base or shift(0, 0, 0), frames)
    return frames


def tool(body: Body, q: Sequence[float], base: Matrix | None = None) -> Matrix:
    """The frame of the last link."""
    return place(body, q, base)[tip(body)]


def deck(body: Body) -> float:
    """The height of a mobile's uppermost face, m."""
    frames = place(body, (0.0, 0.0))
    tops = [
        at(frames[link["link"]])[2] + shape["xyz"][2] + shape["size"][2] / 2
        for link in links(body)
        for shape in link["shapes"]
        if shape["kind"] == "box"
    ]
    return max(tops, default=0.0)


def floor(at: Sequence[float]) -> Matrix:
    """A frame that stands on the floor: x, y in m, yaw in rad."""
    x, y, yaw = at
    return times(shift(x, y, 0), turn((0, 0, 1), yaw))


def shift(x: float, y: float, z: float) -> Matrix:
    return ((1, 0, 0, x), (0, 1, 0, y), (0, 0, 1, z), (0, 0, 0, 1))


def turn(axis: Sequence[float], angle: float) -> Matrix:
    """A turn by `angle` rad about an axis of length 1."""
    x, y, z = axis
    c, s = math.cos(angle), math.sin(angle)
    d = 1 - c
    return (
        (c + x * x * d, x * y * d - z * s, x * z * d + y * s, 0),
        (y * x * d + z * s, c + y * y * d, y * z * d - x * s, 0),
        (z * x * d - y * s, z * y * d + x * s, c + z * z * d, 0),
        (0, 0, 0, 1),
    )


def pose(xyz: Sequence[float], rpy: Sequence[float]) -> Matrix:
    """The frame of a URDF origin: turned about x, then y, then z of the parent, then shifted."""
    roll, pitch, yaw = rpy
    turned = times(turn((0, 0, 1), yaw), times(turn((0, 1, 0), pitch), turn((1, 0, 0), roll)))
    return times(shift(*xyz), turned)


def times(a: Matrix, b: Matrix) -> Matrix:
    """The frame `b` inside `a`, in the frame in which `a` is. Written out, as this is called often."""
    columns = tuple(zip(*b, strict=True))
    return tuple(tuple([x * i + y * j + z * k + w * m for i, j, k, m in columns]) for x, y, z, w in a)


def at(matrix: Matrix, point: Point = (0, 0, 0)) -> Point:
    """A point of a frame, in the frame around it."""
    x, y, z = (sum(a * b for a, b in zip(row, (*point, 1), strict=True)) for row in matrix[:3])
    return (x, y, z)


def upright(frame: Matrix, axis: Sequence[float]) -> float:
    """The uprightness of an axis of a frame, from -1 to 1."""
    return sum(a * b for a, b in zip(frame[2][:3], axis, strict=True))


def flat(matrix: Matrix) -> list[float]:
    """The 16 numbers of a frame, row by row."""
    return [value for row in matrix for value in row]


def _place(body: Body, q: Sequence[float], above: Matrix, frames: dict[str, Matrix]) -> None:
    here = times(above, pose(body["xyz"], body["rpy"]))
    moves = body["moves"]
    if moves is not None:
        here = times(here, _moved(moves["type"], moves["axis"], q[moves["index"]]))
    frames[body["link"]] = here
    for child in body["children"]:
        _place(child, q, here, frames)


def _moved(kind: str, axis: Sequence[float], value: float) -> Matrix:
    if kind == "turn":
        return turn(axis, value)
    x, y, z = axis
    return shift(x * value, y * value, z * value)
