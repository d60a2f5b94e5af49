"""Course of a tree as a file of BehaviorTree.CPP's FileLogger2, which its viewers play."""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence

from . import groot2_messages as messages
from .groot2_messages import Transition
from .groot2_tree import CellTree, Row, form_of

MAGIC = b"BTCPP4-FileLogger2"
FORMAT = 1
Look = tuple[int, Sequence[Row]]  # Unix time in microseconds, and the rows of the tree


def btlog(looks: Iterable[Look], *, has_succeeded: bool) -> bytes:
    """The file for a tree's rows at each moment of a change, in order; the first moment has rows.

    The file has one tree: of a task that was tried again with another tree, the last.
    """
    every = list(looks)
    form = next(form_of(rows) for _, rows in reversed(every) if rows)
    mine = [(at_us, rows) for at_us, rows in every if not rows or form_of(rows) == form]
    tree = CellTree(next(rows for _, rows in mine if rows))
    began_us = mine[0][0]
    changes = [
        Transition(at_us=at_us - began_us, node=node, status=status)
        for at_us, rows in mine
        for node, status in tree.stand(rows, has_succeeded=has_succeeded and at_us == mine[-1][0])
    ]
    head = MAGIC + struct.pack("<Bi", FORMAT, len(tree.xml)) + tree.xml + struct.pack("<q", began_us)
    return head + messages.transitions(changes)
