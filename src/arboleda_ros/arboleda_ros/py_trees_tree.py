"""Tree of a cell for py_trees_ros: behaviours with ids, made of a snapshot's rows."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

Row = Mapping[str, Any]
NOBODY = bytes(16)
BEHAVIOUR, SEQUENCE, SELECTOR, PARALLEL, DECORATOR = 1, 2, 3, 4, 6
TYPES = {"sequence": SEQUENCE, "selector": SELECTOR, "parallel": PARALLEL}
STATUSES = {"INVALID": 1, "RUNNING": 2, "SUCCESS": 3, "FAILURE": 4}
NOT_A_BLACKBOX = 4
NONE_YET: tuple[Row, ...] = (
    {"path": "root", "name": "no task yet", "kind": "idle", "status": "INVALID", "feedback": ""},
)


@dataclass(frozen=True, kw_only=True)
class Behaviour:
    """Node; the names and numbers are those of `py_trees_ros_interfaces/msg/Behaviour`."""

    name: str
    class_name: str
    own_id: bytes
    parent_id: bytes
    child_ids: tuple[bytes, ...]
    current_child_id: bytes
    tip_id: bytes
    type: int
    status: int
    message: str
    is_active: bool


def behaviours(cell: str, rows: Sequence[Row]) -> list[Behaviour]:
    """The tree of a cell, its root first; a node keeps its id as long as the tree has the same nodes."""
    below: dict[str, list[str]] = {row["path"]: [] for row in rows}
    for path in below:
        if path != "root":
            below[_parent(path)].append(path)
    status = {row["path"]: row["status"] for row in rows}
    tree = "\n".join(f"{row['path']} {row['name']} {row['kind']}" for row in rows)
    ids = {path: hashlib.sha256(f"{cell}\n{path}\n{tree}".encode()).digest()[:16] for path in below}
    return [_behaviour(row, below, status, ids) for row in rows]


def idle(rows: Sequence[Row]) -> list[Row]:
    """The rows of the tree, with no node at work."""
    return [{**row, "status": "INVALID", "feedback": ""} for row in rows]


def variables(cell: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """The variables of a cell beside its tree: state, task, and the parameters of its steps."""
    yield "cell/state", str(cell["state"])
    if cell["task"] is not None:
        yield "task/id", str(cell["task"]["id"])
        yield "task/text", str(cell["task"]["text"])
    for row in cell["tree"]:
        for name, value in row["parameters"].items() if row["status"] != "INVALID" else ():
            yield f"{row['name']}/{name}", str(value)


def _behaviour(
    row: Row, below: Mapping[str, list[str]], status: Mapping[str, str], ids: Mapping[str, bytes]
) -> Behaviour:
    path = row["path"]
    current = _current(below[path], status)
    return Behaviour(
        name=str(row["name"]),
        class_name=str(row["kind"]),
        own_id=ids[path],
        parent_id=NOBODY if path == "root" else ids[_parent(path)],
        child_ids=tuple(ids[child] for child in below[path]),
        current_child_id=NOBODY if current is None else ids[current],
        tip_id=ids[_tip(path, below, status)],
        type=TYPES.get(row["kind"], DECORATOR if len(below[path]) == 1 else BEHAVIOUR),
        status=STATUSES.get(row["status"], 0),
        message=str(row["feedback"]),
        is_active=row["status"] != "INVALID",
    )


def _parent(path: str) -> str:
    return path.rpartition(".")[0] or "root"


def _current(children: Sequence[str], status: Mapping[str, str]) -> str | None:
    """The child that is at work, else the last child that was."""
    running = [child for child in children if status[child] == "RUNNING"]
    ended = [child for child in children if status[child] != "INVALID"]
    return next(iter(running or ended[-1:]), None)


def _tip(path: str, below: Mapping[str, list[str]], status: Mapping[str, str]) -> str:
    """The lowest node at work."""
    while (child := _current(below[path], status)) is not None:
        path = child
    return path
