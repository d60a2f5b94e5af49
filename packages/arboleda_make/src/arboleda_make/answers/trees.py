"""Trees as XML, node by node."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any


@dataclass(frozen=True, kw_only=True)
class TreeFile:
    """File of trees that is a recipe of the plant, as it was read."""

    recipe: str
    file: str
    cells: list[str]
    text: str


@dataclass(frozen=True, kw_only=True)
class TreeMark:
    """Finding of `check`, on the node that it is about."""

    sentence: str
    mistake: Annotated[bool, "A warning where it is false."]
    line: int
    column: int
    tree: Annotated[str | None, "None where it is about no node."]
    path: Annotated[str | None, '"root", or like "0.2"; "" for the tree itself.']
    attribute: str | None


@dataclass(frozen=True, kw_only=True)
class DrawnTree:
    """Tree of a file, node by node."""

    name: str
    main: bool
    parameters: list[dict[str, str]]
    nodes: Annotated[
        list[dict[str, Any]],
        "Path, kind, category, attributes, fewest and most nodes in it, in the order of the file.",
    ]


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """File as an editor shows it; `text` is that after the operation."""

    text: str
    trees: list[DrawnTree]
    marks: list[TreeMark]


@dataclass(frozen=True, kw_only=True)
class TreeCopy:
    """Recipe in Python as the text of a tree."""

    text: Annotated[str, "The whole file."]


@dataclass(frozen=True, kw_only=True)
class Nodes:
    """Nodes of one sort: of a device, by its role, or of Arboleda."""

    sort: Annotated[str, "device, python, usual, control, decorator, condition, action or others."]
    name: Annotated[str, "The role of the device."]
    kinds: Annotated[list[dict[str, Any]], "Name, category, ports, fewest and most nodes in it."]
