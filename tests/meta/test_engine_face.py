"""The engine is seen through one face of at most 60 names, each of which somebody outside reaches for."""

from __future__ import annotations

import ast
import inspect
import re
from pathlib import Path
from types import ModuleType

import pytest

import arboleda
from arboleda import engine
from arboleda.engine import inspection

ROOT = Path(__file__).parents[2]
HOUSE = Path(arboleda.__file__).parent
MOST = 60
OUTSIDE = (HOUSE, *(ROOT / each for each in ("packages", "src/arboleda_ros", "examples", "tools")))
FILES = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
ENGINE = ("core", "dispatch", "engine", "resume", "trees")


def reached_for(module: str) -> set[str]:
    """The names that modules outside of the engine, and files on pages of the documentation, import of it."""
    assert all(folder.is_dir() for folder in OUTSIDE)
    paths = [path for folder in OUTSIDE for path in folder.rglob("*.py")]
    outside = [path for path in paths if not {HOUSE / each for each in ENGINE} & {*path.parents}]
    texts = [text for path in outside if module in (text := path.read_text(encoding="utf-8"))]
    pages = (path.read_text(encoding="utf-8") for path in (ROOT / "docs").rglob("*.md"))
    texts += [file for page in pages for file in FILES.findall(page) if module in file]
    nodes = [node for text in texts for node in ast.walk(ast.parse(text))]
    imports = [node for node in nodes if isinstance(node, ast.ImportFrom) and node.module == module]
    return {alias.name for each in imports for alias in each.names}


def test_the_face_has_at_most_60_names_and_none_is_a_module() -> None:
    assert len(engine.__all__) <= MOST
    assert not any(inspect.ismodule(getattr(engine, name)) for name in engine.__all__)


@pytest.mark.parametrize("module", [engine, inspection], ids=lambda module: module.__name__)
def test_each_name_is_there_once_and_reached_for(module: ModuleType) -> None:
    names = module.__all__
    assert len(set(names)) == len(names)
    assert set(names) == reached_for(module.__name__) - {"inspection"}


@pytest.mark.parametrize(
    ("name", "function"), [("paths", "follow"), ("reasons", "of_hold"), ("steps", "task")]
)
def test_a_former_module_goes_on_with_a_warning(name: str, function: str) -> None:
    with pytest.warns(DeprecationWarning, match="from `arboleda.engine` itself"):
        assert inspect.isfunction(getattr(getattr(engine, name), function))


def insides() -> set[str]:
    """The chains of attributes that the inspection reads, as `.dispatcher.beliefs`."""
    tree = ast.parse(Path(str(inspection.__file__)).read_text(encoding="utf-8"))
    read = [node.value for node in tree.body if isinstance(node, ast.AnnAssign)]
    return {f".{ast.literal_eval(call.args[0])}" for call in read if isinstance(call, ast.Call)}


def test_packages_look_into_a_plant_through_the_inspection() -> None:
    chains = insides()
    assert ".dispatcher.beliefs" in chains
    paths = [path for folder in (ROOT / "packages").glob("*/src") for path in folder.rglob("*.py")]
    texts = {path: path.read_text(encoding="utf-8") for path in paths}
    assert [
        f"{path.name}:{node.lineno}: {ast.unparse(node)}"
        for path, text in texts.items()
        if any(chain in text for chain in chains)
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Attribute) and any(ast.unparse(node).endswith(chain) for chain in chains)
    ] == []
