"""A tree of the plant as XML that viewers of BehaviorTree.CPP show: the rows of a tree -> text.

Free viewers show 20 nodes of a tree, so a larger tree is divided into subtrees. Where one node has too many
children, groups of them become subtrees of the node's kind, which are marked with `_part`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from . import names, writing
from .nodes import BUILT_IN, Category, Kind, Port, by_name, children
from .writing import Tag

LARGEST = 20  # nodes of one tree
PART = "_part"
CONTROLS: Mapping[str, tuple[str, Mapping[str, str]]] = {
    "sequence": ("Sequence", {}),
    "selector": ("Fallback", {}),
    "parallel": ("Parallel", {"success_count": "-1", "failure_count": "1"}),
}
CONDITIONS = ("condition",)
TAKEN = frozenset([*BUILT_IN, *(each.value for each in Category)])


@dataclass(frozen=True, kw_only=True)
class LiveNode:
    """Numbered node of a tree that is watched.

    `paths` are the rows whose status it shows: one row, or several for a node that stands for a group.
    `tree` is the path of its tree.
    """

    kind: str
    paths: tuple[str, ...]
    tree: str


@dataclass(frozen=True, kw_only=True)
class LiveTree:
    """Tree for a viewer that watches it; the attribute `_uid` of each node numbers `nodes` from 1."""

    text: str
    main: str
    nodes: tuple[LiveNode, ...]


def export(rows: Sequence[Mapping[str, Any]]) -> str:
    """The XML of a tree of these rows (path, name, kind, parameters), as `views/tree_view.py` makes them."""
    writer = _Writer()
    main = writer.tree(_tree_of(rows))
    own_kinds = [kind for kind in writer.kinds.values() if kind.name not in BUILT_IN]
    return writing.document([*writer.trees, writing.models(own_kinds)], main_tree_to_execute=main)


def live(rows: Sequence[Mapping[str, Any]]) -> LiveTree:
    """The tree of these rows, with the numbers and paths that BehaviorTree.CPP gives to viewers."""
    writer = _LiveWriter()
    main = writer.tree(_tree_of(rows))
    writer.trees[0] = replace(writer.trees[0], attributes={"ID": main, "_fullpath": ""})
    used = {node.kind: BUILT_IN[node.kind] for node in writer.nodes if node.kind in BUILT_IN}
    text = writing.document([*writer.trees, writing.models((used | writer.kinds).values())])
    return LiveTree(text=text, main=main, nodes=tuple(writer.nodes))


def _tree_of(rows: Sequence[Mapping[str, Any]]) -> _Node:
    nodes = {row["path"]: _Node(row) for row in rows}
    for path, node in nodes.items():
        if path != "root":
            nodes[path.rpartition(".")[0] or "root"].children.append(node)
    return nodes["root"]


@dataclass
class _Node:
    """Row with the nodes below it."""

    row: Mapping[str, Any]
    children: list[_Node] = field(default_factory=list)
    is_part: bool = False
    is_apart: bool = False  # it is a tree of its own

    @property
    def title(self) -> str:
        return str(self.row["name"])

    @property
    def paths(self) -> tuple[str, ...]:
        """The paths of the rows whose status the node shows."""
        if not self.is_part:
            return (str(self.row["path"]),)
        return tuple(path for child in self.children for path in child.paths)


@dataclass
class _Writer:
    trees: list[Tag] = field(default_factory=list)
    kinds: dict[str, Kind] = field(default_factory=dict)
    _names: set[str] = field(default_factory=set)

    def tree(self, node: _Node) -> str:
        """Write a node as a tree of its own, before the trees inside it; returns the name of the tree."""
        _divide(node)
        name = self._free_name(node.title)
        position = len(self.trees)
        root = self._tag(node)
        self.trees.insert(position, Tag("BehaviorTree", {"ID": name}, [root]))
        return name

    def _tag(self, node: _Node) -> Tag:
        row = node.row
        control = CONTROLS.get(row["kind"])
        below = [self._below(child) for child in node.children]
        if control is not None and below:
            return Tag(control[0], {"name": node.title, **control[1]}, below)
        kind = self._kind(row, around=len(below))
        attributes = {
            name: str(value)
            for name, value in row.get("parameters", {}).items()
            if name in (kind.ports or {})
        }
        return Tag(kind.name, {"name": node.title, **attributes}, below)

    def _below(self, node: _Node) -> Tag:
        return self._subtree(node) if node.is_apart else self._tag(node)

    def _kind(self, row: Mapping[str, Any], *, around: int) -> Kind:
        """The kind of a node for a viewer; it has the ports of all nodes of its name."""
        category = Category.CONDITION if row["kind"] in CONDITIONS else Category.ACTION
        if around:
            category = Category.DECORATOR if around == 1 else Category.CONTROL
        name = _name(f"{row['kind']}_{category.value}" if around else row["kind"])
        before = self.kinds.get(name)
        new = [Port(name=each) for each in row.get("parameters", {}) if names.of_port(str(each)) is None]
        ports = {**(before.ports or {} if before is not None else {}), **by_name(new)}
        fewest, most = children(category)
        self.kinds[name] = Kind(name=name, category=category, ports=ports, fewest=fewest, most=most)
        return self.kinds[name]

    def _subtree(self, node: _Node) -> Tag:
        part = {PART: "true"} if node.is_part else {}
        return Tag("SubTree", {"ID": self.tree(node), "name": node.title, **part})

    def _free_name(self, title: str) -> str:
        free = self._next_name(title)
        self._names.add(free)
        return free

    def _next_name(self, title: str) -> str:
        return next(each for each in _numbered(_name(title)) if each not in self._names)


@dataclass
class _LiveWriter(_Writer):
    """Writer that numbers the nodes, each before the nodes below it."""

    nodes: list[LiveNode] = field(default_factory=list)
    _tree: str = ""  # the path of the tree that is being written

    def _tag(self, node: _Node) -> Tag:
        number = self._number(node)
        tag = super()._tag(node)
        self.nodes[number - 1] = replace(self.nodes[number - 1], kind=tag.name)
        return replace(tag, attributes={**tag.attributes, "_uid": str(number)})

    def _subtree(self, node: _Node) -> Tag:
        number, around, position = self._number(node), self._tree, len(self.trees)
        name = self._next_name(node.title)
        self._tree = f"{around}/{name}::{number}" if around else f"{name}::{number}"
        path = self._tree
        self.tree(node)
        self._tree = around
        written = self.trees[position]
        self.trees[position] = replace(written, attributes={**written.attributes, "_fullpath": path})
        return Tag("SubTree", {"ID": name, "_fullpath": path, "_uid": str(number)})

    def _number(self, node: _Node) -> int:
        self.nodes.append(LiveNode(kind="SubTree", paths=node.paths, tree=self._tree))
        return len(self.nodes)


def _divide(root: _Node) -> None:
    """Divide a tree until it is small enough; of the parts that fit, the largest becomes a tree first."""
    while len(own := list(_own(root))) > LARGEST:
        open_ones = [node for node in own if node is root or not node.is_apart]
        sizes = [(len(list(_own(node))), node) for node in open_ones if node.children and node is not root]
        fitting = [each for each in sizes if each[0] <= LARGEST]
        if fitting:
            max(fitting, key=lambda each: each[0])[1].is_apart = True
        else:
            _group(max(open_ones, key=lambda node: len(node.children)))


def _group(node: _Node) -> None:
    """Group neighbouring children, each group below a node of the same kind."""
    many = LARGEST - 1
    groups = [node.children[start : start + many] for start in range(0, len(node.children), many)]
    node.children = [
        _Node(row={**node.row, "name": f"{node.title} {number}"}, children=group, is_part=True, is_apart=True)
        for number, group in enumerate(groups, start=1)
    ]


def _own(root: _Node) -> Iterator[_Node]:
    """The nodes of a tree; a tree inside it counts as one node."""
    waiting = [root]
    while waiting:
        node = waiting.pop()
        yield node
        if not node.is_apart or node is root:
            waiting += reversed(node.children)


def _name(text: str) -> str:
    """A name that editors accept: each word with a capital."""
    letters = "".join(each if each.isalnum() and each.isascii() else " " for each in text)
    name = "".join(word[:1].upper() + word[1:] for word in letters.split()) or "Node"
    return f"A{name}" if name[0].isdigit() or names.of_node(name) or name in TAKEN else name


def _numbered(name: str) -> Iterator[str]:
    yield name
    number = 2
    while True:
        yield f"{name}{number}"
        number += 1
