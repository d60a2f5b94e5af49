"""Contents of files of trees: trees of nodes, and models of kinds of nodes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from .findings import Place
from .markup import Attribute
from .nodes import Category, Kind
from .values import PRIVATE


@dataclass(frozen=True, kw_only=True)
class Node:
    """Node of a tree.

    `kind`: in the spelling of version 4. `tag`: the word of the explicit form, None for the compact one.
    `own`: attributes that are no ports, such as those of editors, which are kept.
    """

    kind: str
    tag: Category | None = None
    name: str = ""
    ports: Mapping[str, Attribute] = field(default_factory=dict)
    own: Mapping[str, Attribute] = field(default_factory=dict)
    children: tuple[Node, ...] = ()
    place: Place

    def port(self, name: str) -> str | None:
        """The text written for a port; None if there is none."""
        found = self.ports.get(name)
        return None if found is None else found.value

    def iterate(self) -> Iterator[Node]:
        """The node and all below it, in the order of the file."""
        waiting = [self]
        while waiting:
            node = waiting.pop()
            yield node
            waiting += reversed(node.children)

    @property
    def is_subtree(self) -> bool:
        return self.kind == Category.SUBTREE.value

    @property
    def shares_names(self) -> bool:
        """True if a subtree sees all variables of the tree around it by their names."""
        words = ("_autoremap", "__autoremap", "__shared_blackboard")
        values = (self.own[word].value for word in words if word in self.own)
        return any(value.lower() in ("true", "1") for value in values)

    def shares(self, variable: str) -> bool:
        """True if a subtree sees this variable of the tree around it only because it shares names."""
        return (
            self.is_subtree
            and self.shares_names
            and variable not in self.ports
            and not variable.startswith(PRIVATE)
        )


@dataclass(frozen=True, kw_only=True)
class Tree:
    """Tree by its name; `own`: attributes of editors, which are kept."""

    name: str
    root: Node
    own: Mapping[str, Attribute] = field(default_factory=dict)
    place: Place


@dataclass(frozen=True, kw_only=True)
class Metadata:
    """Metadata of a model: a key with a text, which are no port."""

    key: str
    text: str
    place: Place


@dataclass(frozen=True, kw_only=True)
class Forest:
    """Trees of a file and of those that it includes.

    `own`: the names of built-in kinds by which they declare other ones. `metadata`: those of the models of
    trees. `main`: the tree to execute, if that is clear. `is_whole`:
    every included file was read.
    """

    trees: Mapping[str, Tree]
    models: Mapping[str, Kind]
    own: frozenset[str] = frozenset()
    metadata: Mapping[str, tuple[Metadata, ...]] = field(default_factory=dict)
    main: str | None
    is_whole: bool = True

    def inside(self, tree: str) -> list[str]:
        """The trees that a tree contains, each as often as it occurs."""
        names = (node.own["ID"].value for node in self.trees[tree].root.iterate() if node.is_subtree)
        return [name for name in names if name in self.trees]
