"""The package data of the pip and of the colcon build are the same."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_both_builds_of_the_core_take_the_same_files_along() -> None:
    (listed,) = re.findall(r"^arboleda = (\[.*?^\])", (ROOT / "pyproject.toml").read_text(), re.M | re.S)
    tree = ast.parse((ROOT / "src/arboleda/setup.py").read_text())
    keywords = [node for node in ast.walk(tree) if isinstance(node, ast.keyword)]
    (by_colcon,) = (ast.literal_eval(node.value) for node in keywords if node.arg == "package_data")
    assert sorted(by_colcon["arboleda"]) == sorted(ast.literal_eval(listed))
