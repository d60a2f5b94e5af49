"""The URDF of each robot: well formed, with the agreed names, and bodies that can exist."""

from __future__ import annotations

from importlib.resources import files
from typing import Any

import pytest
import yaml

from arboleda_description.urdf import models, render

from .drawn import moving, read

ROOT = {"scara": "base_link", "cr10a": "base_link", "mobile": "grid_link"}
LINKS = {
    "scara": ["base_link", "arm_link", "forearm_link", "quill_link", "effector_link", "tool0"],
    "cr10a": ["base_link", *(f"link{number}" for number in range(1, 7)), "tool0"],
    "mobile": ["grid_link", "base_link"],
}
JOINTS = {
    "scara": ["brazo_joint", "antebrazo_joint", "efector_joint"],
    "cr10a": [f"joint{number}" for number in range(1, 7)],
    "mobile": ["x_joint", "y_joint"],
}


def numbers(model: str) -> dict[str, Any]:
    text = files("arboleda_description").joinpath(f"robots/{model}.yaml").read_text(encoding="utf-8")
    return yaml.safe_load(text)


def determinant(a: list[list[float]]) -> float:
    return (
        a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1])
        - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0])
        + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0])
    )


def test_every_model_is_drawn() -> None:
    assert set(models()) == set(ROOT)


def test_a_model_that_nobody_drew_is_named_with_the_others() -> None:
    with pytest.raises(ValueError, match=r"no urdf/scarab\.urdf\.xacro; there are cr10a, mobile, scara"):
        render("scarab", prefix="")


@pytest.mark.parametrize("prefix", ["", "r1_", "rm_sis_a_"])
@pytest.mark.parametrize("model", ROOT)
def test_links_and_joints_have_the_agreed_names(model: str, prefix: str) -> None:
    robot = read(render(model, prefix=prefix))
    assert robot.get_root() == prefix + ROOT[model]
    assert {prefix + link for link in LINKS[model]} <= set(robot.link_map)
    assert [joint.name for joint in moving(robot)] == [prefix + name for name in JOINTS[model]]
    named = [*robot.link_map, *robot.joint_map, *(material.name for material in robot.materials)]
    assert all(name.startswith(prefix) for name in named)


@pytest.mark.parametrize("model", ROOT)
def test_every_joint_joins_links_that_exist_and_every_link_hangs_on_the_root(model: str) -> None:
    robot = read(render(model, prefix=""))
    assert {end for joint in robot.joints for end in (joint.parent, joint.child)} == set(robot.link_map)
    assert len(robot.link_map) == len(robot.links) == len(robot.joints) + 1
    for link in robot.link_map:
        assert robot.get_chain(robot.get_root(), link)[0] == ROOT[model]


@pytest.mark.parametrize("model", ROOT)
def test_what_is_seen_is_also_hit_and_has_a_colour_that_is_defined(model: str) -> None:
    robot = read(render(model, prefix=""))
    colours = {material.name for material in robot.materials if material.color}
    for link in robot.links:
        seen = [
            (shape.origin.xyz, shape.origin.rpy, shape.geometry.to_xml_string()) for shape in link.visuals
        ]
        hit = [
            (shape.origin.xyz, shape.origin.rpy, shape.geometry.to_xml_string()) for shape in link.collisions
        ]
        assert seen == hit
        assert {shape.material.name for shape in link.visuals} <= colours
        assert (link.inertial is not None) == bool(link.visuals)


@pytest.mark.parametrize("model", ROOT)
def test_masses_are_those_of_the_model_and_inertias_those_of_bodies(model: str) -> None:
    robot, given = read(render(model, prefix="")), numbers(model)
    bodies = [link.inertial for link in robot.links if link.inertial]
    assert [body.mass for body in bodies] == given.get("link_masses_kg", [given.get("mass_kg")])
    for body in bodies:
        a = body.inertia.to_matrix()
        minors = (a[0][0], a[0][0] * a[1][1] - a[0][1] * a[1][0], determinant(a))
        assert all(minor > 0 for minor in minors)
        small, middle, large = sorted(a[axis][axis] for axis in range(3))
        assert small + middle >= large * (1 - 1e-9)  # no body breaks this triangle


def test_an_inertia_is_that_of_the_solid_drawn() -> None:
    robot = read(render("scara", prefix=""))
    quill, arm = robot.link_map["quill_link"].inertial, robot.link_map["arm_link"].inertial
    across = 0.5 * (3 * 0.010**2 + 0.300**2) / 12  # a cylinder of 0.5 kg
    expected = pytest.approx((across, across, 0.5 * 0.010**2 / 2))
    assert (quill.inertia.ixx, quill.inertia.iyy, quill.inertia.izz) == expected
    along, over = 7 * (0.120**2 + 0.050**2) / 12, 7 * (0.65**2 + 0.050**2) / 12  # a box of 7 kg
    assert (arm.inertia.ixx, arm.inertia.iyy) == pytest.approx((along, over))
    assert arm.origin.xyz == pytest.approx([0.325, 0, 0.025])
