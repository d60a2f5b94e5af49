"""The shapes make one robot: nothing floats, it stands on the floor, and its tool is the end of it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import pytest
from urdf_parser_py.urdf import Cylinder, Robot

from arboleda_description.urdf import render

from .drawn import Matrix, Point, at, inverse, moving, place, pose, product, read

TOUCHING = 1e-6  # m
PIECES = 8
ENDS = {"scara": "effector_link", "cr10a": "link6"}


@dataclass(frozen=True, kw_only=True)
class Solid:
    """A shape of a link, in the root's frame."""

    link: str
    geometry: Any
    where: Matrix

    @cached_property
    def back(self) -> Matrix:
        return inverse(self.where)

    def holds(self, point: Point) -> bool:
        x, y, z = at(self.back, point)
        if isinstance(self.geometry, Cylinder):
            inside = math.hypot(x, y) <= self.geometry.radius + TOUCHING
            return inside and abs(z) <= self.geometry.length / 2 + TOUCHING
        return all(abs(v) <= s / 2 + TOUCHING for v, s in zip((x, y, z), self.geometry.size, strict=True))

    def points(self) -> Iterator[Point]:
        """A lattice through it, its surface included."""
        across = [2 * n / PIECES - 1 for n in range(PIECES + 1)]
        for a, b, c in itertools.product(across, across, across):
            if isinstance(self.geometry, Cylinder):
                radius, angle = self.geometry.radius * (a + 1) / 2, b * math.pi
                local = (radius * math.cos(angle), radius * math.sin(angle), c * self.geometry.length / 2)
            else:
                x, y, z = self.geometry.size
                local = (a * x / 2, b * y / 2, c * z / 2)
            yield at(self.where, local)

    def touches(self, other: Solid) -> bool:
        return any(map(other.holds, self.points())) or any(map(self.holds, other.points()))


def solids(robot: Robot, q: Sequence[float] = ()) -> list[Solid]:
    places = {link.name: place(robot, link.name, q) for link in robot.links}
    return [
        Solid(link=link.name, geometry=shape.geometry, where=product(places[link.name], pose(shape.origin)))
        for link in robot.links
        for shape in link.visuals
    ]


def body_of(robot: Robot) -> dict[str, int]:
    """Each link's rigid body: how many moving joints lie between it and the root."""
    root = robot.get_root()
    return {link: len(robot.get_chain(root, link, links=False, fixed=False)) for link in robot.link_map}


def in_one_piece(parts: Sequence[Solid]) -> bool:
    """Whether one can get from the first to each other one over shapes that touch."""
    reached, left = [parts[0]], list(parts[1:])
    while reached and left:
        here = reached.pop()
        near = [part for part in left if here.touches(part)]
        left = [part for part in left if part not in near]
        reached += near
    return not left


def poses(robot: Robot) -> list[tuple[float, ...]]:
    """Both ends of every joint, and the middle."""
    limits = [joint.limit for joint in moving(robot)]
    ends = [tuple(limit.lower for limit in limits), tuple(limit.upper for limit in limits)]
    return [tuple(0.0 for _ in limits), *ends]


@pytest.mark.parametrize("model", ["scara", "cr10a", "mobile"])
def test_each_body_is_in_one_piece(model: str) -> None:
    robot = read(render(model, prefix=""))
    body = body_of(robot)
    for number in set(body.values()):
        parts = [solid for solid in solids(robot) if body[solid.link] == number]
        assert not parts or in_one_piece(parts)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("model", ENDS)
def test_neighbouring_bodies_touch_wherever_the_joints_are(model: str) -> None:
    robot = read(render(model, prefix=""))
    body = body_of(robot)
    for q in poses(robot):
        parts = solids(robot, q)
        for number in range(len(moving(robot))):
            inner = [solid for solid in parts if body[solid.link] == number]
            outer = [solid for solid in parts if body[solid.link] == number + 1]
            assert inner and outer
            assert any(a.touches(b) for a in inner for b in outer), f"bodies {number}, {number + 1} at {q}"


@pytest.mark.parametrize("model", ["scara", "cr10a", "mobile"])
def test_it_stands_on_the_floor(model: str) -> None:
    lowest = min(point[2] for solid in solids(read(render(model, prefix=""))) for point in solid.points())
    assert lowest == pytest.approx(0, abs=TOUCHING)


@pytest.mark.parametrize("model", ENDS)
def test_the_tool_point_is_the_end_of_the_last_shape(model: str) -> None:
    robot = read(render(model, prefix=""))
    for q in poses(robot):
        tool = place(robot, "tool0", q)
        parts = solids(robot, q)
        assert {solid.link for solid in parts if solid.holds(at(tool))} == {ENDS[model]}
        assert not any(solid.holds(at(tool, (0, 0, 0.001))) for solid in parts)


def test_the_scara_has_the_build_of_one() -> None:
    robot = read(render("scara", prefix=""))
    heights = {
        link.name: [
            point[2] for solid in solids(robot) if solid.link == link.name for point in solid.points()
        ]
        for link in robot.links
        if link.visuals
    }
    column, arm, forearm, quill, effector = heights.values()
    assert max(column) == pytest.approx(min(arm)) and max(arm) == pytest.approx(min(forearm))
    assert min(quill) < min(arm) and max(quill) > max(arm)  # it passes through the forearm and hangs below
    assert max(effector) == pytest.approx(min(quill))


def test_a_part_that_floats_is_found() -> None:
    robot = read(render("scara", prefix=""))
    robot.link_map["effector_link"].visuals[0].origin.xyz = [0, 0, -0.1]
    assert not in_one_piece(solids(robot))
