"""File of trees that a person names on the command line: read with all its includes, and checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from arboleda.drivers import plain
from arboleda.extension import ConfigError
from arboleda.plant_file import user_file
from arboleda_trees.bt_xml import checking, reading
from arboleda_trees.bt_xml.checking import TreeCheck
from arboleda_trees.bt_xml.findings import Findings
from arboleda_trees.bt_xml.forest import Forest
from arboleda_trees.bt_xml.markup import LARGEST
from arboleda_trees.bt_xml.nodes import Kind

from . import tree_includes

MOST = 10  # unknown leaves that are named
LONGEST = 500  # characters of a line


@dataclass(frozen=True, kw_only=True)
class TreeFile:
    """A file without mistakes; `warnings` has a line for each."""

    forest: Forest
    checked: TreeCheck
    warnings: tuple[str, ...]


def load(path: Path, allowed: Mapping[str, Kind] | None = None) -> TreeFile:
    """The trees of a file and of the files that it includes; ConfigError with every mistake.

    `allowed` are the only kinds of leaves that a tree may have; None: a tree may have any.
    """
    findings = Findings()
    forest = reading.read(str(path), user_file.read_bytes(path, LARGEST), findings, tree_includes.read)
    checked = checking.check(forest, findings, allowed)
    if findings.mistakes:
        raise ConfigError(findings.mistakes)
    return TreeFile(forest=forest, checked=checked, warnings=findings.warnings)


def report(path: Path, allowed: Mapping[str, Kind] | None = None) -> list[str]:
    """The lines about a file without mistakes; ConfigError with every mistake."""
    file = load(path, allowed)
    lines = [*file.warnings, *_unknown(path, file.checked)]
    trees = ", ".join(file.forest.trees) or "none"
    lines.append(f"{path}: good: {file.checked.nodes} nodes; trees {trees}")
    return [plain(line, LONGEST) for line in lines]


def _unknown(path: Path, checked: TreeCheck) -> list[str]:
    if not checked.unknown:
        return []
    names = sorted(checked.unknown)
    more = f" and {len(names) - MOST} more" if len(names) > MOST else ""
    why = "which a plant or a program has to bring"
    return [f"{path}: note: {len(names)} kinds of leaves, {why}: {', '.join(names[:MOST])}{more}"]
