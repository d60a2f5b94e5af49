"""Nodes of a tree, in the order of py_trees' `iterate`, which makes a generator for each of its levels."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

MOST = 100_000  # more than anybody draws: a node must be among its own children


def nodes_of(tree: Behaviour) -> list[Behaviour]:
    """All nodes of a tree: children in their order and before their parents, so its root is the last.

    RecursionError, as from `iterate`, for a tree without an end.
    """
    nodes: list[Behaviour] = []
    pending = [tree]
    while pending:
        node = pending.pop()
        nodes.append(node)
        pending += node.children
        if len(nodes) > MOST:
            raise RecursionError(f"{tree.name} has more than {MOST} nodes: one is among its own children")
    nodes.reverse()
    return nodes
