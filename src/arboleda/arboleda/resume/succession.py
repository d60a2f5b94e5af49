"""Succession of steps in a tree: where the success of one can only lead to another."""

from __future__ import annotations

from py_trees.behaviour import Behaviour
from py_trees.composites import Selector, Sequence

from arboleda.trees.leaves import Announce, Carry, Dwell, Leaf, Note, Piece

PASSED = (Announce, Carry, Dwell, Note, Piece)
"""Leaves that command nothing and take nothing: what comes after them proves that they have ended well."""


def steps_between(before: Behaviour, after: Behaviour) -> list[Leaf] | None:
    """The leaves that are passed where all goes well, from one step to another; None where another way may
    lead there, or something else be commanded or taken on it.
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
    """The leaf that begins once a node has ended well."""
    while node.parent is not None:
        parent = node.parent
        if type(parent) is Sequence and parent.memory:
            at = parent.children.index(node) + 1
            if at < len(parent.children):
                return _first(parent.children[at])
        elif type(parent) is not Selector or node is not parent.children[-1]:
            return None  # what comes after a selector may come after another of its children, too
        node = parent
    return None


def _first(node: Behaviour) -> Behaviour | None:
    """The leaf with which a node begins."""
    while node.children:
        if type(node) is not Selector and not (type(node) is Sequence and node.memory):
            return None
        node = node.children[0]
    return node
