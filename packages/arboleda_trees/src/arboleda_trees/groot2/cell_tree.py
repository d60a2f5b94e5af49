"""Tree of a cell for Groot2: the XML made of a snapshot's rows, and the status of each node."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from arboleda_trees.bt_xml.export import LiveNode, LiveTree, live

from .messages import IDLE_FROM, MOST_NODES, NodeStatus

Row = Mapping[str, Any]
STATUSES = {status.name: status for status in NodeStatus} | {"INVALID": NodeStatus.IDLE}
NONE_YET: tuple[Row, ...] = ({"path": "root", "name": "no task yet", "kind": "idle", "status": "INVALID"},)


class CellTree:
    """The tree that a cell runs, or ran last. A node that is idle again keeps its last result.

    A tree with the same nodes has the same name of 16 bytes, so that viewers do not load it again.
    """

    def __init__(self, rows: Sequence[Row]) -> None:
        shown = rows[: MOST_NODES // 2]  # a node that is a tree of its own has two numbers
        self.tree: LiveTree = live([{**row, "parameters": {}} for row in shown])
        self.xml = self.tree.text.encode()
        self.name = _uuid(self.xml)
        self.codes = [0] * len(self.tree.nodes)
        self._form = form_of(rows)

    def is_of(self, rows: Sequence[Row]) -> bool:
        return form_of(rows) == self._form

    def stand(self, rows: Sequence[Row], *, has_succeeded: bool = False) -> Iterator[tuple[int, NodeStatus]]:
        """Take the status of each node, idle without rows; returns each changed one, by the node's number.

        A tree is gone as soon as it has ended, before its last status is seen. Where its task
        `has_succeeded`, the nodes that were running have, too.
        """
        for number in [
            number for number, code in enumerate(self.codes, start=1) if code == NodeStatus.RUNNING
        ]:
            if has_succeeded and not rows:
                self.codes[number - 1] = NodeStatus.SUCCESS
                yield number, NodeStatus.SUCCESS
        status_by_path = {row["path"]: STATUSES.get(row["status"], NodeStatus.IDLE) for row in rows}
        for number, node in enumerate(self.tree.nodes, start=1):
            before, status = self.codes[number - 1], _status(node, status_by_path)
            if status is NodeStatus.IDLE and before < IDLE_FROM:
                self.codes[number - 1] = IDLE_FROM + before if before else 0
            elif status is not NodeStatus.IDLE:
                self.codes[number - 1] = status
            if status != (before if before < IDLE_FROM else NodeStatus.IDLE):
                yield number, status

    def values(self, rows: Sequence[Row]) -> dict[str, dict[str, Any]]:
        """The values of nodes by the path of their tree, of the main tree by its name."""
        values_by_tree: dict[str, dict[str, Any]] = {
            node.tree or self.tree.main: {} for node in self.tree.nodes
        }
        row_by_path = {row["path"]: row for row in rows}
        for number, node in enumerate(self.tree.nodes, start=1):
            row = row_by_path.get(node.paths[0], {}) if node.kind != "SubTree" else {}
            if row.get("parameters"):
                values_by_tree[node.tree or self.tree.main][f"{number} {row['name']}"] = row["parameters"]
        return values_by_tree


def form_of(rows: Sequence[Row]) -> list[tuple[str, str, str]]:
    """The part of a tree that stays the same while it runs."""
    return [(row["path"], row["name"], row["kind"]) for row in rows]


def _status(node: LiveNode, status_by_path: Mapping[str, NodeStatus]) -> NodeStatus:
    """The status of a node by its rows: it runs while one of them does, and succeeds once all have."""
    there = [status_by_path.get(path, NodeStatus.IDLE) for path in node.paths]
    if len(there) == 1:
        return there[0]
    for status in (NodeStatus.RUNNING, NodeStatus.FAILURE):
        if status in there:
            return status
    return NodeStatus.SUCCESS if all(each is NodeStatus.SUCCESS for each in there) else NodeStatus.IDLE


def _uuid(content: bytes) -> bytes:
    """A UUID in the form of version 4, the same for the same content."""
    name = bytearray(hashlib.sha256(content).digest()[:16])
    name[6] = name[6] & 0x0F | 0x40
    name[8] = name[8] & 0x3F | 0x80
    return bytes(name)
