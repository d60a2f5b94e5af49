"""Where links are: the twin's own arithmetic against another reader of the same URDF, and against numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pytest

from arboleda.geometry import kinematics
from arboleda.geometry.bodies import Body, links
from arboleda.plant_file.urdf import robot_urdf
from arboleda.testing import shipped

from ..description import drawn

ACCURACY = 1e-9  # m, and of unit vectors
HALF = math.pi / 2
POSES = {
    "ra1": [(0, 0, 0), (0.7, -1.3, 0.03), (-2.5, 2.2, 0.1)],
    "ra3": [(0,) * 6, (0.6, 0.2, -1.1, 0.3, 1.5, -2.0), (-6.0, 3.0, 2.7, -4.0, 5.0, 6.1)],
    "rm_sis_b": [(0, 0), (0.2, 0.4)],
}


@pytest.mark.parametrize(("name", "q"), [(name, q) for name, poses in POSES.items() for q in poses], ids=str)
def test_every_link_is_where_another_reader_has_it(
    drawings: dict[str, Body], name: str, q: Sequence[float]
) -> None:
    other = drawn.read(robot_urdf(shipped(), name))
    frames = kinematics.place(drawings[name], q)
    assert (
        frames.keys()
        == {link["link"] for link in links(drawings[name])}
        == {link.name for link in other.links}
    )
    for link, frame in frames.items():
        expected = [value for row in drawn.place(other, link, q) for value in row]
        assert kinematics.flat(frame) == pytest.approx(expected, abs=ACCURACY)


@pytest.mark.parametrize(
    ("name", "q", "tool"),
    [
        ("ra1", (0, 0, 0), (1.17, 0, 0.15)),
        ("ra1", (HALF, 0, 0.1), (0, 1.17, 0.05)),
        ("ra1", (0, HALF, 0), (0.65, 0.52, 0.15)),
        ("ra3", (0, 0, 0, 0, 0, 0), (0, -0.2994, 1.4765)),
        ("ra3", (HALF, 0, 0, 0, 0, 0), (0.2994, 0, 1.4765)),
    ],
)
def test_the_tool_is_where_the_drawing_of_the_robot_says(
    drawings: dict[str, Body], name: str, q: Sequence[float], tool: Sequence[float]
) -> None:
    assert kinematics.at(kinematics.tool(drawings[name], q)) == pytest.approx(tool, abs=1e-6)


def test_a_base_turns_and_shifts_what_stands_on_it(drawings: dict[str, Body]) -> None:
    base = kinematics.floor((1.0, 2.0, HALF))
    assert kinematics.at(kinematics.tool(drawings["ra1"], (0, 0, 0), base)) == pytest.approx((1, 3.17, 0.15))
