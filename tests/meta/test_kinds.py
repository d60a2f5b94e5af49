"""The engine, the simulator and the screens ask what a device can do, never which kind of device it is."""

import ast
import inspect
import pkgutil
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest
from tests.packages import PACKAGES

import arboleda
import arboleda.kinds
import arboleda.recipes
from arboleda.model.plant_model import Cell, Robot
from arboleda.plant_file.shipped_kinds import COME_WITH_IT

ROOT = Path(arboleda.__file__).parent
ROOTS = (ROOT, *(PACKAGES[f"arboleda_{each}"] for each in ("fleet", "make", "proofs")))
ENGINE = ("model", "dispatch", "trees", "resume", "core")
ABOVE = (
    "cli",
    "playback",
    "site",
    "campaigns",
    "runtime",
    "plant_check",
    "plant_file",
    "web",
    "store",
    "drafts",
    "versions",
    "teaching",
    "trying",
    "mending",
    "proposals",
    "standby",
    "postgres",
)
ROOMS = (*ENGINE, *ABOVE, "wire", "views", "adapters", "sim", "simulator", "dashboard", "testing")
NAMED_AS_ROLES = {
    "plant_file/robot_models.py",  # of the files of models that come with it
    "plant_file/robots.py",
    "plant_file/shapes.py",
    "plant_file/yaml_model.py",
    "dashboard/twin/parts.py",  # the twin of a cell of storage
    "dashboard/twin/scene.py",
    "dashboard/twin/twin.py",
    "playback/incident.py",  # slots of sentences
    "simulator/invariants/rows.py",  # what only storage knows
    "simulator/invariants/screens.py",
}
"""Where the two robots of a cell of storage are called by their roles, or the model of one by its name."""
REGISTRY = "plant_file/shipped_kinds.py"  # where kinds that come with it get their names
FACT = "effector"  # also what an arm says of itself
KINDS = COME_WITH_IT.keys() - {FACT}


def _concrete() -> set[str]:
    """The names of every kind of robot and of cell that comes with it."""
    modules = [
        import_module(info.name)
        for package in (arboleda.kinds, arboleda.recipes)
        for info in pkgutil.iter_modules(package.__path__, f"{package.__name__}.")
    ]
    classes = [each for module in modules for each in vars(module).values() if inspect.isclass(each)]
    return {each.__name__ for each in classes if issubclass(each, Robot | Cell)} - {"Robot", "Cell"}


def _files(package: str) -> Iterator[tuple[str, Path]]:
    """The modules of a package of the runner, or of one beside it, by their places in it."""
    assert any((root / package).is_dir() for root in ROOTS), package
    for root in ROOTS:
        yield from ((str(path.relative_to(root)), path) for path in sorted((root / package).rglob("*.py")))


@cache
def _nodes(code: str) -> list[ast.AST]:
    return list(ast.walk(ast.parse(code)))


def _questions(code: str, names: set[str]) -> Iterator[str]:
    """Each place where a value is compared with one of these classes."""
    if not any(name in code for name in names):
        return
    for node in _nodes(code):
        asks = isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("isinstance", "issubclass")
        compares = isinstance(node, ast.Compare) and "type(" in ast.unparse(node)
        if (asks or compares) and any(getattr(part, "id", "") in names for part in ast.walk(node)):
            yield f"line {node.lineno}: {ast.unparse(node)}"


def test_the_kinds_are_found():
    assert {"Arm", "Mobile", "Person", "Device"} <= _concrete()


@pytest.mark.parametrize(
    "code",
    [
        "isinstance(robot, Arm)",
        "isinstance(a.b, (Arm, Mobile))",
        "type(robot) is Arm",
        "issubclass(x, Arm | Mobile)",
    ],
)
def test_a_question_is_found(code):
    assert list(_questions(code, {"Arm", "Mobile"}))


@pytest.mark.sampled(8)
@pytest.mark.parametrize("package", ROOMS)
def test_no_module_asks_which_kind_a_device_is(package):
    found = [
        f"{name} {each}"
        for name, path in _files(package)
        for each in _questions(path.read_text(), _concrete())
    ]
    assert not found, (
        f"ask for what it can do (`joints`, `floor_grid`, `verb_names`, a table by class): {found}"
    )


def _names_of_kinds(package: str) -> dict[str, set[str]]:
    """By its file, the names of kinds that the code of a package has as a text of their own."""
    names = {
        name: {
            node.value
            for node in _nodes(code)
            if isinstance(node, ast.Constant) and isinstance(node.value, str)
        }
        & KINDS
        for name, path in _files(package)
        if (code := path.read_text()) and any(name in code for name in KINDS)
    }
    return {file: found for file, found in names.items() if found and file != REGISTRY}


@pytest.mark.sampled(4)
@pytest.mark.parametrize("package", [*ENGINE, *ABOVE, "dashboard", "simulator"])
def test_no_module_names_a_kind(package: str) -> None:
    roles = {"arm", "mobile"}
    found = {
        file: names - roles if file in NAMED_AS_ROLES else names
        for file, names in _names_of_kinds(package).items()
    }
    assert not any(found.values()), f"ask for what it can do: {found}"


def test_every_module_that_calls_robots_by_their_roles_does_so() -> None:
    found = {file for package in (*ABOVE, "dashboard", "simulator") for file in _names_of_kinds(package)}
    assert found == NAMED_AS_ROLES
