"""The table of operations, and the one function that carries them out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from . import node_edits, tree_edits
from .operations import (
    AddTree,
    Extract,
    Insert,
    Move,
    Operation,
    Remove,
    RemoveParameter,
    RemoveTree,
    RenameTree,
    Replace,
    SetAttribute,
    SetParameter,
    Unwrap,
    Wrap,
)
from .tree_text import BOM, TreeText

EDITS: Mapping[type, Callable[[TreeText, Any], bytes]] = {
    Insert: node_edits.insert,
    Move: node_edits.move,
    Remove: node_edits.remove,
    Replace: node_edits.replace,
    Wrap: node_edits.wrap,
    Unwrap: node_edits.unwrap,
    SetAttribute: node_edits.set_attribute,
    AddTree: tree_edits.add,
    RemoveTree: tree_edits.remove,
    RenameTree: tree_edits.rename,
    Extract: tree_edits.extract,
    SetParameter: tree_edits.set_parameter,
    RemoveParameter: tree_edits.remove_parameter,
}


def apply(text: str, operation: Operation) -> str:
    """The text after an operation; all that it does not change stays byte for byte.

    Raises EditError, with a sentence for people, where the text cannot be read or the operation cannot be
    done.
    """
    content = EDITS[type(operation)](TreeText(text), operation)
    changed = (BOM if text.startswith(BOM) else "") + content.decode()
    TreeText(changed)  # a text that cannot be read again is refused
    return changed
