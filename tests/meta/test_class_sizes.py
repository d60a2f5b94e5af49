"""No class of the product has more than 25 methods, its own and those that it takes from our classes."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
SOURCES = (ROOT / "src/arboleda", ROOT / "src/arboleda_ros", *sorted((ROOT / "packages").glob("*/src")))
MOST = 25
LARGER: Mapping[str, int] = {
    "arboleda.rig.rig.Rig": 52,
    "arboleda_proofs.simulator.truth.arm.ArmTruth": 44,
    "arboleda.rig.world.World": 41,
    "arboleda_proofs.simulator.truth.machine.MachineTruth": 37,
    "arboleda_class.notebook.world.World": 36,
    "arboleda_proofs.simulator.truth.truth.Truth": 34,
    "arboleda.sim.board.Board": 32,
    "arboleda.rig.plant_process.PlantProcess": 31,
    "arboleda_proofs.simulator.truth.mobile.MobileTruth": 31,
    "arboleda.sim.machine.MachineBody": 30,
    "arboleda_proofs.testing.sim.Sim": 30,
    "arboleda_proofs.simulator.truth.robot.RobotTruth": 29,
    "arboleda_make.client.draft.AsyncDraft": 26,
    "arboleda_make.client.draft.Draft": 26,
    "arboleda.plant_check.foresight.Foresight": 26,
}
"""Classes with more, and how many they have: none may grow, and none may come."""


class Written(NamedTuple):
    """A class as it is written: the names of its methods, and of the classes from which it takes others."""

    methods: frozenset[str]
    bases: tuple[str, ...]


@cache
def written() -> tuple[dict[str, Written], dict[str, str]]:
    """All classes by name, and the names that modules import, each with what it means."""
    classes: dict[str, Written] = {}
    meanings: dict[str, str] = {}
    for source in SOURCES:
        for path in sorted(source.rglob("*.py")):
            if "test" not in path.relative_to(source).parts[:2]:
                _read(path, source, classes, meanings)
    return classes, meanings


def _read(path: Path, source: Path, classes: dict[str, Written], meanings: dict[str, str]) -> None:
    parts = path.relative_to(source).with_suffix("").parts
    package = parts[:-1]
    module = ".".join(package if parts[-1] == "__init__" else parts)
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else ()
            start = ".".join((*above, *([node.module] if node.module else [])))
            for alias in node.names:
                meanings[f"{module}.{alias.asname or alias.name}"] = f"{start}.{alias.name}"
        elif isinstance(node, ast.ClassDef):
            kinds = (ast.FunctionDef, ast.AsyncFunctionDef)
            methods = frozenset(each.name for each in node.body if isinstance(each, kinds))
            bases = (each.value if isinstance(each, ast.Subscript) else each for each in node.bases)
            classes[f"{module}.{node.name}"] = Written(
                methods, tuple(f"{module}.{ast.unparse(b)}" for b in bases)
            )


def methods_of(name: str) -> frozenset[str]:
    """The names of all methods of a class; none of what is not ours."""
    classes, meanings = written()
    for _ in range(5):  # a package may offer what a module of its has
        head, _, last = name.rpartition(".")
        if name not in classes and head in meanings:  # a class of an imported module
            name = f"{meanings[head]}.{last}"
        name = meanings.get(name, name) if name not in classes else name
    if name not in classes:
        return frozenset()
    found = classes[name]
    return found.methods.union(*map(methods_of, found.bases))


def test_no_class_has_more_than_25_methods() -> None:
    counts = {name: len(methods_of(name)) for name in written()[0]}
    assert len(counts) > 1000
    larger = {name: count for name, count in counts.items() if count > MOST}
    assert larger == LARGER
