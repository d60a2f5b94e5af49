"""Tests of the runner import no package beside it."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from .conftest import OF_THE_WHOLE

TESTS = Path(__file__).parents[1]
PACKAGES = {
    "packages",
    *(f"arboleda_{name}" for name in ("boards", "class", "drivers", "fleet", "make", "proofs")),
}  # by name: also where they are not there


def imported(file: Path) -> Iterator[str]:
    """The modules that a file imports by name, wherever in it."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (each.name for each in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield node.module


def test_what_tests_of_the_runner_import_is_there_without_packages() -> None:
    files = {
        path.relative_to(TESTS).as_posix(): PACKAGES & {name.partition(".")[0] for name in imported(path)}
        for path in sorted(TESTS.rglob("*.py"))
    }
    assert len(files) > 400
    assert [name for name, packages in files.items() if packages] == []


def test_what_is_left_out_without_packages_is_there_with_them() -> None:
    named = [Path(__file__).with_name(f"test_{name}.py") for name in OF_THE_WHOLE]
    assert [file.name for file in named if not file.exists()] == []
