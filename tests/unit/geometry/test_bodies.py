"""A URDF as the twin reads it, and one that it cannot draw."""

from __future__ import annotations

import re

import pytest

from arboleda.geometry import bodies, kinematics
from arboleda.geometry.bodies import Body
from arboleda.plant_file.urdf import root_link
from arboleda.testing import shipped

ROBOT = """<robot name="r"><link name="a"/><link name="b"><visual><geometry>{shape}</geometry></visual></link>
<joint name="j" type="{kind}"><parent link="a"/><child link="b"/>{more}</joint></robot>"""

MESH = '<mesh filename="package://mine/link.stl"/>'
MESHES = """<robot name="r">
<link name="a"><visual><geometry><mesh filename="a.stl"/></geometry></visual></link>
<link name="b"><visual><geometry><mesh filename="b.stl"/></geometry></visual>
<collision><geometry><box size="1 2 3"/></geometry></collision></link>
<link name="my_tool0"/><link name="tool0"/>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0.3 0 0.4"/>
<axis xyz="0 0 2"/></joint>
<joint name="k" type="fixed"><parent link="b"/><child link="my_tool0"/></joint>
<joint name="l" type="fixed"><parent link="a"/><child link="tool0"/></joint></robot>"""

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
        (ROBOT.format(shape="<cone/>", kind="fixed", more=""), "one of box, cylinder, sphere, not cone"),
        (
            ROBOT.format(shape=MESH, kind="revolute", more='<axis xyz="0 0 0"/>'),
            "an axis must point somewhere",
        ),
        (ROBOT.format(shape="", kind="fixed", more=""), "not nothing"),
        ('<robot name="r"><link name="a"/><link name="b"/></robot>', "has the roots a, b"),
        (ASTRAY, "the link c, which is not there"),
    ],
    ids=["damaged", "a cone", "an axis of no length", "no shape", "two roots", "a missing link"],
)
def test_what_cannot_be_drawn_says_why(text: str, sentence: str) -> None:
    with pytest.raises(ValueError, match=re.escape(sentence)):
        bodies.read(text)


def test_a_mesh_has_stand_ins_that_join_its_joints() -> None:
    (ball, tube) = bodies.read(MESHES)["shapes"]
    assert (ball["kind"], ball["color"]) == ("sphere", bodies.GREY)
    assert (tube["kind"], tube["size"][1], tube["xyz"]) == ("cylinder", pytest.approx(0.5), [0.15, 0, 0.2])
    ends = [kinematics.at(kinematics.pose(tube["xyz"], tube["rpy"]), (0, 0, z)) for z in (-0.25, 0.25)]
    assert ends == [pytest.approx((0, 0, 0), abs=1e-9), pytest.approx((0.3, 0, 0.4))]


def test_a_mesh_is_drawn_by_what_it_hits_with_where_that_is_plain() -> None:
    shapes = bodies.read(MESHES)["children"][0]["shapes"]
    assert [(shape["kind"], shape["size"]) for shape in shapes] == [("box", [1, 2, 3])]


def test_an_axis_has_length_one() -> None:
    assert bodies.read(MESHES)["children"][0]["moves"]["axis"] == [0, 0, 1]


def test_the_tip_is_tool0_even_on_a_short_way() -> None:
    assert bodies.tip(bodies.read(MESHES)) == "tool0"
    assert [link["link"] for link in bodies.tool_chain(bodies.read(MESHES))] == ["a", "tool0"]
