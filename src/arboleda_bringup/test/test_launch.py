"""The launch file itself, loaded without ROS 2's launch: every row becomes one action, with typed values."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

pytest.importorskip("rclpy")

from arboleda.testing import shipped
from arboleda_bringup.arguments import ARGUMENTS
from arboleda_ros import running

PACKAGE = Path(__file__).parents[1]
PAGE = PACKAGE.parents[1] / "docs/how-to/ros2.md"
Launched = Callable[..., list[Any]]


def nodes(actions: list[Any]) -> list[Any]:
    return [action for action in actions if action.kind == "Node"]


def values(node: Any) -> dict[str, Any]:
    (parameters,) = node.parameters
    return {key: value.words[0] for key, value in parameters.items()}


def test_every_argument_is_declared_described_and_on_its_page(description: list[Any]) -> None:
    declared = [entity for entity in description if entity.kind == "DeclareLaunchArgument"]
    assert [argument.words[0] for argument in declared] == [argument.name for argument in ARGUMENTS]
    page = PAGE.read_text()
    for argument in declared:
        assert argument.description
        assert argument.choices is None or argument.default_value in argument.choices
        assert f"`{argument.words[0]}`" in page


def test_every_parameter_is_one_that_the_node_declares(launched: Launched) -> None:
    ours = [node for node in nodes(launched()) if node.package == "arboleda_ros"]
    assert len(ours) == 3
    for node in ours:
        declared = running.offered(node.executable)
        assert {key: type(value) for key, value in values(node).items() if key not in declared} == {}
        for key, value in values(node).items():
            assert type(value) is type(declared[key][0]), key


def test_every_value_has_a_type_so_that_no_text_is_read_as_yaml(launched: Launched) -> None:
    for node in nodes(launched()):
        for value in (value for values in node.parameters for value in values.values()):
            assert (value.kind, value.value_type) == ("ParameterValue", type(value.words[0]))


def test_a_robot_hangs_in_the_world_by_the_root_of_its_description(launched: Launched) -> None:
    roots, hung = {}, {}
    for node in nodes(launched()):
        if node.package == "robot_state_publisher":
            robot = ET.fromstring(values(node)["robot_description"])
            links = {link.get("name") for link in robot.findall("link")}
            roots[node.namespace] = links - {child.get("link") for child in robot.findall("joint/child")}
        elif node.package == "tf2_ros":
            hung[node.namespace] = {node.arguments[-1]}
    assert roots == hung
    assert len(roots) == 6


def test_a_robot_is_described_with_the_joints_that_the_bridge_names(launched: Launched) -> None:
    robots = {robot.joint_states.topic: robot for robot in shipped().robots.values()}
    described = [node for node in nodes(launched()) if node.package == "robot_state_publisher"]
    assert {f"{node.namespace}/joint_states" for node in described} == robots.keys()
    for node in described:
        joints = ET.fromstring(values(node)["robot_description"]).findall("joint")
        moving = [joint.get("name") for joint in joints if joint.get("type") != "fixed"]
        assert moving == list(robots[f"{node.namespace}/joint_states"].joint_states.joints)


def test_the_view_shows_every_robot_of_the_shipped_plant_in_the_world(launched: Launched) -> None:
    every = nodes(launched())
    (rviz,) = [node for node in every if node.package == "rviz2"]
    view = yaml.safe_load(Path(rviz.arguments[1]).read_text())["Visualization Manager"]
    models = [each for each in view["Displays"] if each["Class"] == "rviz_default_plugins/RobotModel"]
    topics = [model["Description Topic"]["Value"] for model in models]
    described = [node for node in every if node.package == "robot_state_publisher"]
    assert topics == [f"/{node.namespace}/robot_description" for node in described]
    assert view["Global Options"]["Fixed Frame"] == "world"


def test_all_nodes_of_a_launch_stay_on_this_machine_and_a_line_says_so(description: list[Any]) -> None:
    *declared, function = description
    texts = {argument.words[0]: argument.default_value for argument in declared}
    context = type("Context", (), {"launch_configurations": texts, "environment": {}})
    entity, *_ = function.function(context)
    assert context.environment == {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    assert entity.kind == "LogInfo" and "LOCALHOST" in entity.msg


def test_a_library_that_is_missing_is_one_sentence(launched: Launched, tmp_path: Path) -> None:
    (tmp_path / "pydantic.py").write_text("raise ModuleNotFoundError('gone', name='pydantic')\n")
    os.environ["PYTHONPATH"] = os.pathsep.join([str(tmp_path), os.environ["PYTHONPATH"]])
    with pytest.raises(
        RuntimeError, match=r"^the Python library pydantic cannot be used here \(gone\); [^\n]+$"
    ):
        launched()


def test_the_end_of_a_part_ends_the_launch(launched: Launched) -> None:
    for node in nodes(launched()):
        ends = [action.kind for action in node.on_exit or []]
        assert ends == (["Shutdown"] if node.package == "arboleda_ros" else [])


def test_a_plant_file_of_ones_own_decides_which_robots_there_are(launched: Launched) -> None:
    example = PACKAGE.parents[1] / "examples/plants/joints.yaml"
    described = [node for node in nodes(launched(plant=os.fspath(example))) if node.package == "tf2_ros"]
    assert [node.namespace for node in described] == ["r1", "rm_sis_a"]


def test_a_plant_file_with_a_mistake_is_refused_with_its_line(launched: Launched, tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text("name: Mine!\n")
    with pytest.raises(RuntimeError, match=r"mine\.yaml:1:"):
        launched(plant=os.fspath(file))
