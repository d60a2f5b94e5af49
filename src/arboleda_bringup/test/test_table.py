"""The nodes that a launch starts, for plants and arguments of every kind."""

from __future__ import annotations

import ast
import math
import re
from dataclasses import replace
from pathlib import Path

import pytest

from arboleda.model.errors import StartError
from arboleda.model.plant_model import Link, PlantModel, Robot
from arboleda.testing import shipped
from arboleda_bringup.arguments import ARGUMENTS
from arboleda_bringup.choice import read
from arboleda_bringup.row import Row
from arboleda_bringup.table import table

PACKAGE = Path(__file__).parents[1]
DEFAULTS = {argument.name: argument.default for argument in ARGUMENTS}
COMMON = {"plant": "", "state_dir": "", "rate": 1.0}
DEVICES = ("virtual_devices", {**COMMON, "broker": "embedded"})
BRIDGE = ("mqtt_bridge", {**COMMON, "broker": "127.0.0.1:1883"})
PAGE = {"dashboard": True, "dashboard_port": 0}
ALONE = ("orchestrator", {**COMMON, **PAGE})  # its robots need no broker
ORCHESTRATOR = ("orchestrator", {**COMMON, "broker": "127.0.0.1:1883", **PAGE})


def rows(plant: PlantModel | None = None, /, **given: str) -> list[Row]:
    choice = read({**DEFAULTS, **given})
    return table(plant or shipped(), choice, urdf=lambda robot: f"urdf of {robot}", share="/share")


def ours(table: list[Row]) -> list[tuple[str, dict[str, object]]]:
    return [(row.executable, dict(row.parameters)) for row in table if row.package == "arboleda_ros"]


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({}, [DEVICES, BRIDGE, ORCHESTRATOR]),
        ({"orchestrator": "false"}, [DEVICES, BRIDGE]),
        (
            {"dashboard": "false"},
            [DEVICES, BRIDGE, ("orchestrator", {**ORCHESTRATOR[1], "dashboard": False})],
        ),
        (
            {"sim": "false", "broker": "10.0.0.2:1884"},
            [(name, {**more, "broker": "10.0.0.2:1884"}) for name, more in (BRIDGE, ORCHESTRATOR)],
        ),
        (
            {"broker": "10.0.0.2:1884", "orchestrator": "false"},
            [(name, {**COMMON, "broker": "10.0.0.2:1884"}) for name in ("virtual_devices", "mqtt_bridge")],
        ),
        (
            {"port": "8090"},
            [DEVICES, BRIDGE, ("orchestrator", {**ORCHESTRATOR[1], "dashboard_port": 8090})],
        ),
        (
            {"plant": "mine.yaml", "state_dir": "here", "rate": "10"},
            [
                (name, {**more, "plant": "mine.yaml", "state_dir": "here", "rate": 10.0})
                for name, more in (DEVICES, BRIDGE, ORCHESTRATOR)
            ],
        ),
    ],
    ids=[
        "defaults",
        "no orchestrator",
        "no dashboard",
        "real boards",
        "bridge alone",
        "port of the page",
        "values passed on",
    ],
)
def test_the_plant_is_put_together_as_asked(
    given: dict[str, str], expected: list[tuple[str, dict[str, object]]]
) -> None:
    assert ours(rows(**given)) == expected


def test_the_launch_ends_with_any_part_of_the_plant_and_with_nothing_else() -> None:
    assert {row.executable for row in rows() if row.required} == {name for name, _ in ours(rows())}


def test_every_robot_has_its_description_in_its_own_namespace() -> None:
    found = {row.namespace: row.parameters for row in rows() if row.package == "robot_state_publisher"}
    arms = {f"r{n}": {"robot_description": f"urdf of ra{n}"} for n in (1, 2, 3)}
    mobiles = {f"rm_sis_{x}": {"robot_description": f"urdf of rm_sis_{x}"} for x in "abc"}
    assert found == arms | mobiles


def test_every_robot_stands_where_the_plant_file_says() -> None:
    found = {row.namespace: row.arguments for row in rows() if row.package == "tf2_ros"}
    assert found.keys() == {"r1", "r2", "r3", "rm_sis_a", "rm_sis_b", "rm_sis_c"}
    place = (
        f"--x 0.0 --y 0.0 --z 0.0 --yaw {math.radians(220.6)} --frame-id world --child-frame-id r1_base_link"
    )
    assert " ".join(found["r1"]) == place
    options = dict(zip(found["rm_sis_a"][::2], found["rm_sis_a"][1::2], strict=True))
    assert [float(options[key]) for key in ("--x", "--y", "--z", "--yaw")] == [-0.1, -1.366, 0.0, 0.0]
    assert (options["--frame-id"], options["--child-frame-id"]) == ("world", "rm_sis_a_grid_link")


def test_joints_are_published_only_for_robots_that_are_only_drawn() -> None:
    cell = shipped().cell("sis_a")

    def drawn(robot: Robot) -> Robot:
        return replace(robot, link=Link.NONE) if robot is cell.roles["arm"] else robot

    plant = replace(shipped(), cells=(cell.with_robots(drawn),))
    spoken = [row.namespace for row in rows(plant) if row.package == "joint_state_publisher"]
    assert spoken == ["r1"]
    assert not any(row.package == "joint_state_publisher" for row in rows())
    assert not any(row.package == "joint_state_publisher" for row in rows(shipped(link=Link.ROS)))


def test_rviz_shows_the_view_of_this_package_or_is_left_out() -> None:
    (rviz,) = [row for row in rows() if row.package == "rviz2"]
    assert rviz.arguments == ("-d", "/share/rviz/plant.rviz")
    assert rows(rviz="false", describe="true") == rows()[:-1]


def test_without_rviz_nobody_needs_what_it_draws_unless_asked() -> None:
    def refuse(robot: str) -> str:
        raise AssertionError(f"the description of {robot} is asked for; xacro may not be there")

    alone = table(shipped(), read({**DEFAULTS, "rviz": "false"}), urdf=refuse, share="/share")
    assert {row.package for row in alone} == {"arboleda_ros"}
    drawn = {"robot_state_publisher", "tf2_ros"}
    assert {row.package for row in rows(rviz="false", describe="true")} == {"arboleda_ros", *drawn}
    assert not drawn & {row.package for row in rows(describe="false")}


@pytest.mark.parametrize("link", [Link.ROS, Link.NONE])
def test_robots_without_boards_need_no_broker_no_boards_and_no_bridge(link: Link) -> None:
    assert ours(rows(shipped(link=link))) == [ALONE]


def test_a_broker_that_is_named_reaches_the_plant_without_boards_too() -> None:
    ((_, known),) = ours(rows(shipped(link=Link.ROS), broker="10.0.0.2:1884"))
    assert known["broker"] == "10.0.0.2:1884"


def test_virtual_boards_play_what_drivers_reach_unless_boards_are_real() -> None:
    driven = shipped(link=Link.DRIVER)
    played = [(name, {**more, "virtual": True}) for name, more in (DEVICES, BRIDGE, ORCHESTRATOR)]
    assert ours(rows(driven)) == played
    real = ("orchestrator", {**ORCHESTRATOR[1], "broker": "10.0.0.2:1884"})
    assert ours(rows(driven, sim="false", broker="10.0.0.2:1884")) == [real]


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"sim": "false"}, "with sim:=false name the broker of the real ones: broker:=HOST:PORT"),
        ({"broker": "nowhere:x"}, "'nowhere:x' is not a broker address; write HOST:PORT"),
        ({"port": "http"}, "'http' is not a port; allowed: 1 to 65535"),
        ({"port": "65536"}, "'65536' is not a port; allowed: 1 to 65535"),
        ({"port": "8090", "dashboard": "false"}, "port is for the page (dashboard:=true)"),
        ({"port": "8090", "orchestrator": "false"}, "port is for the page (dashboard:=true)"),
        ({"rate": "fast"}, "'fast' is not a rate; allowed: 0.1 to 100"),
        ({"rate": "0"}, "0 is not a rate; allowed: 0.1 to 100"),
        ({"rate": "2", "sim": "false", "broker": "h:1"}, "rate is for virtual boards (sim:=true)"),
    ],
)
def test_what_does_not_go_together_gets_one_sentence(given: dict[str, str], sentence: str) -> None:
    with pytest.raises(StartError) as refusal:
        read({**DEFAULTS, **given})
    assert sentence in str(refusal.value) and "\n" not in str(refusal.value)


def test_every_package_of_a_row_is_a_dependency_of_this_one() -> None:
    needed = set(re.findall(r"<exec_depend>(.+)</exec_depend>", (PACKAGE / "package.xml").read_text()))
    drawn = rows(shipped(link=Link.NONE))
    assert {row.package for row in drawn} <= needed


def test_every_executable_of_ours_is_a_script_of_arboleda_ros() -> None:
    setup = (PACKAGE.parent / "arboleda_ros/setup.py").read_text()
    texts = [node.value for node in ast.walk(ast.parse(setup)) if isinstance(node, ast.Constant)]
    scripts = {text.partition(" = ")[0] for text in texts if " = arboleda_ros.nodes:" in str(text)}
    assert {name for name, _ in ours(rows())} == scripts
