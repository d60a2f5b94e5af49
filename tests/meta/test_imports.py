"""Third-party packages by layer; `make lint` has the rules of imports between layers."""

from __future__ import annotations

import ast
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "src/arboleda/arboleda"


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
        ("core", {"py_trees"}),
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


def test_only_arboleda_ros_imports_ros() -> None:
    ros = {"rclpy", "std_msgs"}
    named = [path for path in PACKAGE.rglob("*.py") if any(each in path.read_text("utf-8") for each in ros)]
    assert [path.name for path in named if third_party(path) & ros] == []
