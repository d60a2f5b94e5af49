"""Succession of steps in a tree: where the success of one step can only lead to another.

A composite that forgets its place, or a selector with another way, makes that uncertain: then it is None,
and a person judges. Subclasses count as uncertain, since they may go on otherwise.
"""

from __future__ import annotations

from py_trees.behaviour import Behaviour
from py_trees.composites import Selector, Sequence

from arboleda.trees.leaves import Announce, Carry, Dwell, Leaf, Note, Piece

PASSED = (Announce, Carry, Dwell, Note, Piece)
"""Leaves that command nothing and take nothing. A step after them has begun only if they have succeeded."""


def steps_between(before: Behaviour, after: Behaviour) -> list[Leaf] | None:
    """The leaves between two steps, where the first leads to the other by success alone; else None.

    None also where a leaf between them commands or takes something.
    """
    passed: list[Leaf] = []
    leaf = _next(before)
    while leaf is not None and leaf is not after:
        if type(leaf) not in PASSED:
            return None
        passed.append(leaf)  # type: ignore[arg-type]
        leaf = _next(leaf)
    return None if leaf is None else passed


def _next(node: Behaviour) -> Behaviour | None:
    """The leaf that begins once a node has succeeded."""
    while node.parent is not None:
        parent = node.parent
        if type(parent) is Sequence and parent.memory:
            at = parent.children.index(node) + 1
            if at < len(parent.children):
                return _first(parent.children[at])
        elif type(parent) is not Selector or node is not parent.children[-1]:
            return None  # another child of a selector may lead to the same leaf
        node = parent
    return None


def _first(node: Behaviour) -> Behaviour | None:
    """The leaf with which a node begins."""
    while node.children:
        if type(node) is not Selector and not (type(node) is Sequence and node.memory):
            return None
        node = node.children[0]
    return node
