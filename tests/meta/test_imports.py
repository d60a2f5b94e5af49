"""Third-party packages by layer; `make lint` has the rules of imports between layers."""

from __future__ import annotations

import ast
import sys
from graphlib import TopologicalSorter
from pathlib import Path

import grimp
import pytest
from tests.packages import PACKAGES

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "src/arboleda/arboleda"
DRIVERS = PACKAGES["arboleda_drivers"]


def third_party(path: Path) -> set[str]:
    """Packages that the file imports, neither Python's nor its own."""
    nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
    names = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    names |= {str(node.module) for node in nodes if isinstance(node, ast.ImportFrom) and node.level == 0}
    return {name.partition(".")[0] for name in names} - sys.stdlib_module_names - {"arboleda"}


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("layer", "allowed"),
    [
        ("model", {"py_trees"}),
        ("dispatch", set()),
        ("trees", {"py_trees"}),
        ("resume", {"py_trees"}),
        ("core", {"py_trees"}),
        ("departures", set()),
        ("client", {"httpx", "pandas"}),
        ("dashboard", {"fastapi", "nicegui", "yaml"}),
        ("drawing", set()),
        ("drivers", set()),
        ("wire", set()),
        ("sim", set()),
        ("views", {"py_trees"}),
    ],
)
def test_these_layers_need_no_other_package(layer: str, allowed: set[str]) -> None:
    files = sorted((PACKAGE / layer).rglob("*.py"))
    assert files
    assert {path.name: extra for path in files if (extra := third_party(path) - allowed)} == {}


ROS = {"rclpy", "std_msgs"}
SPEAK_ROS = ("gripper_command", "joint_trajectory", "nav2", "ros_action", "ros_mapping")


def imports_ros(path: Path) -> bool:
    return any(each in path.read_text("utf-8") for each in ROS) and bool(third_party(path) & ROS)


def test_only_arboleda_ros_and_the_drivers_of_ros_2_import_ros() -> None:
    assert [path.name for path in PACKAGE.rglob("*.py") if imports_ros(path)] == []
    found = {path.relative_to(DRIVERS).parts[0] for path in DRIVERS.rglob("*.py") if imports_ros(path)}
    assert found <= {*SPEAK_ROS}


def test_no_two_modules_of_the_drivers_need_each_other() -> None:
    graph = grimp.build_graph("arboleda_drivers", cache_dir=None)
    assert len(graph.modules) > 100
    needed = {each: graph.find_modules_directly_imported_by(each) for each in graph.modules}
    TopologicalSorter(needed).prepare()  # a CycleError names them
