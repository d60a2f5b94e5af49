"""The robot models have the design's numbers, and each number has its source."""

from __future__ import annotations

import math
import re
from importlib.resources import files
from pathlib import Path

import pytest
import yaml

from arboleda.plant_file.document import Document
from arboleda.plant_file.robot_models import ArmFile, JointFile, MobileFile, arm_models, mobile_models

PAGE = (Path(__file__).parents[3] / "docs" / "reference" / "robot-models.md").read_text("utf-8")
NAMES = ("scara", "cr10a", "mobile")
GROUPS = ("sizes_mm", "colors_rgba")  # mappings with one source for all that is in them


def numbers(value: object, key: str) -> set[str]:
    """The keys that hold numbers, at any depth; a group counts as one."""
    if isinstance(value, dict) and key not in GROUPS:
        return set().union(*(numbers(each, name) for name, each in value.items()))
    if isinstance(value, list):
        return set().union(*(numbers(each, key) for each in value))
    return {key} if key in GROUPS or isinstance(value, int | float) else set()


@pytest.mark.parametrize("name", NAMES)
def test_each_number_has_a_source_and_each_source_a_number(name: str) -> None:
    robot = yaml.safe_load(files("arboleda_description").joinpath(f"robots/{name}.yaml").read_text("utf-8"))
    assert robot["model"] == name
    assert numbers(robot, "") == set(robot["sources"])


def test_the_scara_is_the_one_of_the_design() -> None:
    q1, q2, q3 = arm_models()["scara"].joints
    assert [joint.name for joint in (q1, q2, q3)] == ["brazo_joint", "antebrazo_joint", "efector_joint"]
    assert (q1.lower, q1.upper) == (math.radians(-150), math.radians(150))
    assert (q2.lower, q2.upper) == (math.radians(-135), math.radians(135))
    assert (q3.lower, q3.upper, q3.pinion_radius_m) == (0, 0.1, 0.0225)
    assert [joint.speed for joint in (q1, q2, q3)] == [math.radians(90), math.radians(90), 0.06]
    assert [joint.acceleration for joint in (q1, q2, q3)] == [math.radians(180), math.radians(180), 0.2]
    assert [q1.step, q2.step] == [math.radians(0.01929), math.radians(0.9)]
    assert q3.step == pytest.approx(math.radians(0.9) * 0.0225)


def test_the_cr10a_is_the_one_of_the_design() -> None:
    joints = arm_models()["cr10a"].joints
    assert [joint.name for joint in joints] == [f"joint{number}" for number in range(1, 7)]
    assert [joint.upper for joint in joints] == [6.27, 6.27, 2.79, 6.27, 6.27, 6.27]
    assert [joint.lower for joint in joints] == [-joint.upper for joint in joints]
    assert [joint.speed for joint in joints] == [2.62, 2.62, 3.14, 3.89, 3.89, 3.89]
    assert {joint.step for joint in joints} == {math.radians(0.01)}
    assert {joint.unit for joint in joints} == {"rad"}


def test_the_mobile_robot_drives_one_edge_a_second() -> None:
    assert mobile_models()["mobile"].speed == 0.2


def test_the_cr10a_keeps_the_origins_and_masses_of_its_maker() -> None:
    document = Document("cr10a", files("arboleda_description").joinpath("robots/cr10a.yaml").read_bytes())
    assert document.value(("link_masses_kg",)) == [1.8265, 4.1649, 11.314, 4.8919, 1.1688, 1.223, 0.2054]
    right = math.pi / 2
    expected = [
        ([0, 0, 0.1765], [0, 0, 0]),
        ([0, 0, 0], [right, right, 0]),
        ([-0.607, 0, 0], [0, 0, 0]),
        ([-0.568, 0, 0.191], [0, 0, -right]),
        ([0, -0.125, 0], [right, 0, 0]),
        ([0, 0.1084, 0], [-right, 0, 0]),
    ]
    joints = document.value(("joints",))
    assert [(joint["origin_xyz_m"], joint["origin_rpy_rad"]) for joint in joints] == expected


def test_the_page_on_robot_models_lists_every_key_and_no_other() -> None:
    rows = re.findall(r"^\| (`.+?) \|", PAGE.partition("## Keys")[2].partition("## Add")[0], re.MULTILINE)
    listed = {key for row in rows for key in re.findall(r"`(\w+)`", row)}
    known = {key for shape in (ArmFile, MobileFile, JointFile) for key in shape.model_fields}
    assert listed == known
