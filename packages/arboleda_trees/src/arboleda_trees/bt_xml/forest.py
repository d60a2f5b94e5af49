"""Contents of files of trees: trees of nodes, and models of kinds of nodes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from arboleda.recipes.of_files import Place

from .markup import Attribute
from .nodes import Category, Kind, Port
from .values import PRIVATE

SHARING = ("_autoremap", "__autoremap", "__shared_blackboard")  # attributes of a subtree that shares names


@dataclass(frozen=True, kw_only=True)
class Node:
    """Node of a tree.

    `kind` is in the spelling of version 4. `tag` is the word of the explicit form, None for the compact form.
    `own` has all attributes that are no ports, such as those of editors.
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
        attribute = self.ports.get(name)
        return None if attribute is None else attribute.value

    def place_of(self, attribute: Attribute) -> Place:
        """The place of an attribute of this node."""
        return Place(self.place.file, attribute.mark)

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
    def subtree(self) -> str:
        """The name of the tree that a subtree stands for."""
        return self.own["ID"].value

    @property
    def shares_names(self) -> bool:
        """True if a subtree sees all variables of the tree around it by their names."""
        values = (self.own[word].value for word in SHARING if word in self.own)
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
    """Tree by its name; `own` has attributes of editors."""

    name: str
    root: Node
    own: Mapping[str, Attribute] = field(default_factory=dict)
    place: Place


@dataclass(frozen=True, kw_only=True)
class Metadata:
    """Metadata of the model of a tree: a key with a text."""

    key: str
    text: str
    place: Place


@dataclass(frozen=True, kw_only=True)
class Forest:
    """Trees of a file and of the files that it includes.

    `own` are names of built-in kinds under which these files declare other kinds. `metadata` are those of the
    models of trees. `main` is the tree to execute, None where that is not clear. `is_whole`: every included
    file was read.
    """

    trees: Mapping[str, Tree]
    models: Mapping[str, Kind]
    own: frozenset[str] = frozenset()
    metadata: Mapping[str, tuple[Metadata, ...]] = field(default_factory=dict)
    main: str | None
    is_whole: bool = True

    def declared_ports(self, tree: str) -> Mapping[str, Port]:
        """The ports that the model of a tree declares; none for a tree without a model."""
        model = self.models.get(tree)
        return {} if model is None or model.ports is None else model.ports

    def metadata_of(self, tree: str, key: str) -> Iterator[Metadata]:
        """The metadata of this key of the model of a tree."""
        return (each for each in self.metadata.get(tree, ()) if each.key == key)

    def inside(self, tree: str) -> list[str]:
        """The trees that a tree contains, each as often as it occurs."""
        names = (node.subtree for node in self.trees[tree].root.iterate() if node.is_subtree)
        return [name for name in names if name in self.trees]
