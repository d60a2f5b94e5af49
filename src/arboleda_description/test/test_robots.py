"""The package as installed carries its robot models and draws them."""

from __future__ import annotations

from importlib.resources import files
from xml.etree import ElementTree

import pytest
import yaml

from arboleda_description.urdf import Limits, render

ROOTS = {"scara": "base_link", "cr10a": "base_link", "mobile": "grid_link"}


@pytest.mark.parametrize("model", ROOTS)
def test_each_robot_model_is_a_mapping(model: str) -> None:
    text = files("arboleda_description").joinpath("robots", f"{model}.yaml").read_text(encoding="utf-8")
    assert isinstance(yaml.safe_load(text), dict)


@pytest.mark.parametrize("model", ROOTS)
def test_each_robot_model_is_drawn_from_one_root(model: str) -> None:
    robot = ElementTree.fromstring(render(model, prefix="x_"))
    children = {child.get("link") for child in robot.iter("child")}
    assert {link.get("name") for link in robot.findall("link")} - children == {f"x_{ROOTS[model]}"}


def test_limits_that_are_given_are_drawn() -> None:
    limits = {"brazo_joint": Limits(-0.5, 0.25, 0.125)}
    robot = ElementTree.fromstring(render("scara", prefix="", limits=limits))
    drawn = {joint.get("name"): joint.find("limit") for joint in robot.findall("joint")}
    limit = drawn["brazo_joint"]
    assert [limit.get(key) for key in ("lower", "upper", "velocity")] == ["-0.5", "0.25", "0.125"]
    assert drawn["efector_joint"].get("upper") == "0.1"
