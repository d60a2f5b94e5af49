"""Operations on a file of trees, as data; each becomes a text that is the old one but for what it changes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, kw_only=True)
class NewNode:
    """Node to be written: its kind, and all its attributes but its name."""

    kind: str
    attributes: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Insert:
    """A new node as the child `index` of the node `parent`; "" is the tree itself, if it is empty."""

    tree: str
    parent: str
    index: int
    node: NewNode


@dataclass(frozen=True, kw_only=True)
class Move:
    """A node with all below it goes to another place, counted before it left; `stays`: here, too."""

    tree: str
    path: str
    to_tree: str
    parent: str
    index: int
    stays: bool = False


@dataclass(frozen=True, kw_only=True)
class Remove:
    """A node goes, with all below it."""

    tree: str
    path: str


@dataclass(frozen=True, kw_only=True)
class Replace:
    """A node becomes one of another kind; its name, what begins with `_` and the nodes below it stay."""

    tree: str
    path: str
    node: NewNode


@dataclass(frozen=True, kw_only=True)
class Wrap:
    """A new node stands around a node."""

    tree: str
    path: str
    node: NewNode


@dataclass(frozen=True, kw_only=True)
class Unwrap:
    """A node goes, and those below it take its place."""

    tree: str
    path: str


@dataclass(frozen=True, kw_only=True)
class SetAttribute:
    """An attribute of a node gets a value; None takes the attribute away."""

    tree: str
    path: str
    name: str
    value: str | None


@dataclass(frozen=True, kw_only=True)
class AddTree:
    """A new tree without a node, after all others."""

    name: str


@dataclass(frozen=True, kw_only=True)
class RemoveTree:
    """A tree goes, with its model."""

    tree: str


@dataclass(frozen=True, kw_only=True)
class RenameTree:
    """A tree gets another name, also wherever it is used."""

    tree: str
    name: str


@dataclass(frozen=True, kw_only=True)
class Extract:
    """A node with all below it becomes a tree of its own, and a SubTree takes its place."""

    tree: str
    path: str
    name: str


@dataclass(frozen=True, kw_only=True)
class SetParameter:
    """A tree has this parameter, with this type ("": by what it is given to) and text for people."""

    tree: str
    name: str
    type: str = ""
    about: str = ""


@dataclass(frozen=True, kw_only=True)
class RemoveParameter:
    """A tree has this parameter no more."""

    tree: str
    name: str


Operation = (
    Insert
    | Move
    | Remove
    | Replace
    | Wrap
    | Unwrap
    | SetAttribute
    | AddTree
    | RemoveTree
    | RenameTree
    | Extract
    | SetParameter
    | RemoveParameter
)
