"""One version and one list of package data, wherever they are written."""

from __future__ import annotations

import ast
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PATTERNS = {
    "pyproject.toml": r'^version = "(.+)"$',
    "package.xml": r"<version>(.+)</version>",
    "setup.py": r'^    version="(.+)",$',
    "__init__.py": r'^__version__ = "(.+)"$',
}


def version_in(path: Path) -> str:
    found = re.search(PATTERNS[path.name], path.read_text(encoding="utf-8"), re.MULTILINE)
    assert found, f"{path.relative_to(ROOT)} names no version"
    return found[1]


def test_every_package_names_the_version_of_pyproject() -> None:
    packages = sorted(
        path.parent for path in (*ROOT.glob("src/*/package.xml"), *ROOT.glob("packages/*/package.xml"))
    )
    files = [
        path for folder in packages for path in (folder / "package.xml", folder / "setup.py") if path.exists()
    ]
    files += [ROOT / "src/arboleda/arboleda/__init__.py", ROOT / "tools/bench/setup.py"]
    versions = {str(path.relative_to(ROOT)): version_in(path) for path in files}
    assert len(versions) >= 10
    assert set(versions.values()) == {version_in(ROOT / "pyproject.toml")}, versions


def test_both_builds_of_the_core_take_the_same_files_along() -> None:
    (listed,) = re.findall(r"^arboleda = (\[.*?^\])", (ROOT / "pyproject.toml").read_text(), re.M | re.S)
    tree = ast.parse((ROOT / "src/arboleda/setup.py").read_text())
    keywords = [node for node in ast.walk(tree) if isinstance(node, ast.keyword)]
    (by_colcon,) = (ast.literal_eval(node.value) for node in keywords if node.arg == "package_data")
    assert sorted(by_colcon["arboleda"]) == sorted(ast.literal_eval(listed))
