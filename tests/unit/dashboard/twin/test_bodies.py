"""A URDF as the twin reads it, and one that it cannot draw."""

from __future__ import annotations

import re

import pytest

from arboleda.app.urdf import root_link
from arboleda.dashboard.twin import bodies
from arboleda.dashboard.twin.bodies import Body
from arboleda.testing import shipped

ROBOT = """<robot name="r"><link name="a"/><link name="b"><visual><geometry>{shape}</geometry></visual></link>
<joint name="j" type="{kind}"><parent link="a"/><child link="b"/>{more}</joint></robot>"""

ASTRAY = """<robot name="r"><link name="a"/>
<joint name="j" type="fixed"><parent link="a"/><child link="c"/></joint></robot>"""


def robot(shape: str = '<sphere radius="0.1"/>', kind: str = "fixed", more: str = "") -> Body:
    return bodies.read(ROBOT.format(shape=shape, kind=kind, more=more))


def test_a_robot_of_the_plant_is_a_tree_from_its_root(drawings: dict[str, Body]) -> None:
    for name, made in shipped().robots.items():
        assert drawings[name]["link"] == root_link(made)


@pytest.mark.parametrize(
    ("name", "tip"), [("ra1", "r1_tool0"), ("ra3", "r3_tool0"), ("rm_sis_a", "rm_sis_a_base_link")]
)
def test_the_tip_is_where_the_tool_is(drawings: dict[str, Body], name: str, tip: str) -> None:
    assert bodies.tip(drawings[name]) == tip


@pytest.mark.parametrize(("name", "joints"), [("ra1", 3), ("ra3", 6), ("rm_sis_a", 2)])
def test_joints_are_counted_from_the_root_outwards(drawings: dict[str, Body], name: str, joints: int) -> None:
    moves = [link["moves"]["index"] for link in bodies.links(drawings[name]) if link["moves"]]
    assert moves == list(range(joints))


def test_a_shape_has_its_size_place_and_colour(drawings: dict[str, Body]) -> None:
    grip = next(link for link in bodies.links(drawings["ra1"]) if link["link"] == "r1_effector_link")
    assert grip["shapes"] == [
        {
            "kind": "cylinder",
            "size": [0.012, 0.04],
            "xyz": [0, 0, -0.02],
            "rpy": [0, 0, 0],
            "color": [0.9, 0.45, 0.1],
        }
    ]


def test_what_is_left_out_has_urdfs_defaults() -> None:
    child = robot(kind="continuous")["children"][0]
    assert (child["xyz"], child["rpy"]) == ([0, 0, 0], [0, 0, 0])
    assert child["moves"] == {"type": "turn", "axis": [1, 0, 0], "index": 0}
    assert child["shapes"][0]["color"] == bodies.GREY


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("<robot", "not XML"),
        (
            ROBOT.format(shape='<mesh filename="x"/>', kind="fixed", more=""),
            "one of box, cylinder, sphere, not mesh",
        ),
        (ROBOT.format(shape="", kind="fixed", more=""), "not nothing"),
        ('<robot name="r"><link name="a"/><link name="b"/></robot>', "has the roots a, b"),
        (ASTRAY, "the link c, which is not there"),
    ],
    ids=["damaged", "a mesh", "no shape", "two roots", "a missing link"],
)
def test_what_cannot_be_drawn_says_why(text: str, sentence: str) -> None:
    with pytest.raises(ValueError, match=re.escape(sentence)):
        bodies.read(text)
