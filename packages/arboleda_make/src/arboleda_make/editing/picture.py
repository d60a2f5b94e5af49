"""Picture of a file for an editor: its trees with all nodes and attributes, as plain data."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from arboleda_trees.bt_xml.markup import Element
from arboleda_trees.bt_xml.nodes import Category, Kind, PortDirection, built_in, children
from arboleda_trees.bt_xml.reading import TAGS

from .tree_edits import MAIN
from .tree_text import TreeText, is_subtree, kind_of, walk

Row = dict[str, Any]


def picture(text: TreeText, kinds: Mapping[str, Kind]) -> list[Row]:
    """The trees of a file: `name`, `main`, `parameters` {name, type}, and `nodes` in the order of the file.

    A node has its `path`, `kind`, `attributes` as they are meant, and how many nodes may stand in it, from
    `fewest` to `most`. `known` is False for a kind that neither `kinds` nor Arboleda has.
    """
    main = text.root.value(MAIN) or (next(iter(text.trees)) if len(text.trees) == 1 else None)
    return [
        {
            "name": name,
            "main": name == main,
            "parameters": _parameters(text.model(name)),
            "nodes": [_node(path, element, kinds) for path, element in walk(tree)],
        }
        for name, tree in text.trees.items()
    ]


def _parameters(model: Element | None) -> list[Row]:
    ports = [] if model is None else model.all(PortDirection.IN.value)
    return [{"name": each.value("name") or "", "type": each.value("type") or ""} for each in ports]


def _node(path: str, element: Element, kinds: Mapping[str, Kind]) -> Row:
    kind = kind_of(element)
    known = built_in(kind) or kinds.get(kind)
    fewest, most = _holds(element, known)
    hidden = "" if is_subtree(element) or element.name not in TAGS else "ID"  # it is the kind
    return {
        "path": path,
        "kind": kind,
        "category": _category(element, known),
        "known": known is not None or is_subtree(element),
        "attributes": {name: each.value for name, each in element.attributes.items() if name != hidden},
        "fewest": fewest,
        "most": most,
    }


def _holds(element: Element, known: Kind | None) -> tuple[int, int]:
    """Most nodes that may stand in a node; of an unknown one as many as its category may have."""
    if known is not None:
        return known.fewest, known.most
    if is_subtree(element):
        return 0, 0
    if element.name in TAGS:
        return children(TAGS[element.name])
    return children(Category.CONTROL) if element.children else (0, 0)


def _category(element: Element, known: Kind | None) -> str:
    if is_subtree(element):
        return Category.SUBTREE.value
    if known is not None:
        return known.category.value
    if element.name in TAGS:
        return element.name
    return str((Category.CONTROL if element.children else Category.ACTION).value)
