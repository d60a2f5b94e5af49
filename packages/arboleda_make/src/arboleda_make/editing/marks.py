"""Marks: what `check` finds in a file, each on the node and the attribute that it is about."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from arboleda.recipes.of_files import Mark
from arboleda_trees.bt_xml import checking, parameters, reading, runnable
from arboleda_trees.bt_xml.findings import Findings, TreeFinding
from arboleda_trees.bt_xml.nodes import Kind
from arboleda_trees.bt_xml.reading import Fetch, MissingInclude

from .tree_text import TreeText, walk

FILE = "tree.xml"
Row = dict[str, Any]
Nodes = Mapping[Mark, tuple[str, str, str | None]]


def not_looked_into(file: str, path: str, package: str) -> tuple[str, bytes]:
    """Raises MissingInclude: the text came from a page, which names no files of this machine."""
    raise MissingInclude((f"{path} was not looked into; `arboleda check` does it",))


def marks(
    text: TreeText, kinds: Mapping[str, Kind], file: str = FILE, fetch: Fetch = not_looked_into
) -> list[Row]:
    """All that `check` says of a file for a cell with these kinds, mistakes first: a TreeMark each."""
    findings = Findings()
    content = text.content
    forest = reading.read(file, content, findings, fetch)
    checking.check(forest, findings, kinds)
    main = forest.main if forest.is_whole and not findings.mistakes else None
    if main is not None and main in forest.trees:
        part = runnable.part_of(forest, main)
        runnable.check(part, findings)
        parameters.check(part, main, kinds, findings)
    nodes = _nodes(text)
    return [_row(each, nodes, file) for each in findings.entries]


def _row(finding: TreeFinding, nodes: Nodes, file: str) -> Row:
    mark, is_here = finding.place.mark, finding.place.file == file
    tree, path, attribute = nodes.get(mark, (None, None, None)) if is_here else (None, None, None)
    where = "" if is_here else f"{finding.place}: "
    return {
        "sentence": f"{where}{finding.sentence}",
        "mistake": finding.is_mistake,
        "line": mark.line,
        "column": mark.column,
        "tree": tree,
        "path": path,
        "attribute": attribute,
    }


def _nodes(text: TreeText) -> Nodes:
    """Tree, path and attribute by the place of each; a tree itself has no path."""
    found: dict[Mark, tuple[str, str, str | None]] = {}
    for name, tree in text.trees.items():
        for path, element in [("", tree), *walk(tree)]:
            found[element.mark] = (name, path, None)
            found |= {each.mark: (name, path, key) for key, each in element.attributes.items()}
    return found
