"""The course of a tree as the file that FileLogger2 of BehaviorTree.CPP writes."""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence

from .cell_tree import CellTree, Row, form_of
from .messages import Transition, transitions

MAGIC = b"BTCPP4-FileLogger2"
FORMAT = 1
Moment = tuple[int, Sequence[Row]]  # Unix time in microseconds, and the rows of the tree


def btlog(moments: Iterable[Moment], *, has_succeeded: bool) -> bytes:
    """The file of FileLogger2 of BehaviorTree.CPP for a tree's rows at each moment of a change, in order.

    The first moment has rows. The file has one tree: of a task that was tried with several trees, the last.
    """
    every = list(moments)
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
    return head + transitions(changes)
