"""The engine is seen through one face of at most 60 names, each of which somebody outside reaches for."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import arboleda
from arboleda import engine
from arboleda.engine import inspection

ROOT = Path(__file__).parents[2]
HOUSE = Path(arboleda.__file__).parent
MOST = 60
OUTSIDE = (HOUSE, *(ROOT / each for each in ("packages", "src/arboleda_ros", "examples", "tools")))
ENGINE = ("core", "dispatch", "engine", "resume", "trees")


def reached_for(module: str) -> set[str]:
    """The names that modules outside of the engine import from one of it."""
    assert all(folder.is_dir() for folder in OUTSIDE)
    paths = [path for folder in OUTSIDE for path in folder.rglob("*.py")]
    outside = [path for path in paths if not {HOUSE / each for each in ENGINE} & {*path.parents}]
    texts = [text for path in outside if module in (text := path.read_text(encoding="utf-8"))]
    nodes = [node for text in texts for node in ast.walk(ast.parse(text))]
    imports = [node for node in nodes if isinstance(node, ast.ImportFrom) and node.module == module]
    return {alias.name for each in imports for alias in each.names}


def test_the_face_has_at_most_60_names() -> None:
    assert len(engine.__all__) <= MOST


@pytest.mark.parametrize("module", [engine, inspection], ids=lambda module: module.__name__)
def test_each_name_is_there_once_and_reached_for(module: object) -> None:
    names: list[str] = module.__all__  # type: ignore[attr-defined]
    assert all(hasattr(module, name) for name in names) and len(set(names)) == len(names)
    assert set(names) == reached_for(module.__name__) - {"inspection"}  # type: ignore[attr-defined]
