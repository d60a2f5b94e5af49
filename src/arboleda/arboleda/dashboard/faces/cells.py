"""The cells: what each is doing, its tree, and what its tree did last."""

from __future__ import annotations

from typing import Any

from arboleda.drawing.layout import parent

from ..tree_drawing import drawing
from ..tree_memory import FAILURE, RUNNING, SUCCESS, TreeMemory
from . import Face
from .moment import Moment, clock, seconds

SHOWN_CHANGES = 12
PHASES = ("main", "recovery")
SIGNS = {"selector": "? ", "sequence": "→ ", "parallel": "⇉ "}  # as behaviour trees are drawn everywhere
GIVEN_UP = ("command", "await")  # what ends by itself has no deadline
Row = dict[str, Any]


def face(moment: Moment) -> Face:
    found: Face = {}
    for cell in moment.snapshot["cells"]:
        memory = moment.trees[cell["name"]]
        found.update(_card(moment, cell, memory))
        found.update(_tree(moment, cell["name"], memory))
        found.update(_changes(moment, cell["name"], memory))
    return found


def _card(moment: Moment, cell: Row, memory: TreeMemory) -> Face:
    words, name = moment.words, cell["name"]
    task = cell["task"] or _last_task(moment, memory)
    leaf = memory.leaf
    state = "failed" if cell["state"] == "idle" and task and task["state"] == "failed" else cell["state"]
    return {
        f"text/{name}.state": [words.of("cell_state", cell["state"]), cell["state"]],
        f"text/{name}.task": [_task_line(moment, task), task["state"] if task else "none"],
        f"text/{name}.step": [words.say(cell["step"]) if cell["step"] else "", ""],
        f"text/{name}.feedback": [words.say(leaf["feedback"]) if leaf and leaf["feedback"] else "", ""],
        f"text/{name}.elapsed": [seconds(cell["task"]["elapsed_s"]) if cell["task"] else "", ""],
        f"text/{name}.left": [_left(moment, leaf), ""],
        f"text/{name}.queue": [_queue(moment, cell), "paused" if cell["paused"] else ""],
        f"text/{name}.trouble": [trouble(moment, cell, task), state],
        f"bar/{name}.progress": progress(memory.rows, memory.statuses) if cell["task"] else None,
    }


def _task_line(moment: Moment, task: Row | None) -> str:
    if task is None:
        return moment.words("cells.no_task")
    ended = "" if task["ended_at"] is None else moment.words.of("task_state", task["state"])
    return f"{task['text']}  {ended}".strip()


def _last_task(moment: Moment, memory: TreeMemory) -> Row | None:
    return next((task for task in moment.snapshot["tasks"] if task["id"] == memory.task), None)


def trouble(moment: Moment, cell: Row, task: Row | None) -> str:
    """What is in the way of a cell, or why its last task failed; "" where all is well."""
    words = moment.words
    if cell["held_by"]:
        return words.say(cell["held_by"])
    if cell["state"] not in ("idle", "execute"):
        return words(f"next.{cell['state']}", cell=cell["name"])
    if cell["state"] == "idle" and cell["waiting_for"]:
        return words.say(cell["waiting_for"])
    return words.say(task["sentence"]) if task is not None and task["state"] == "failed" else ""


def _left(moment: Moment, leaf: Row | None) -> str:
    if leaf is None or leaf["deadline_s"] is None or leaf["kind"] not in GIVEN_UP:
        return ""
    return moment.words("cells.left", time=seconds(leaf["deadline_s"]))


def _queue(moment: Moment, cell: Row) -> str:
    waiting = len(cell["queue"])
    if cell["paused"]:
        key = "cells.queue_paused" if waiting else "cells.queue_paused_empty"
        return moment.words(key, count=waiting)
    return moment.words("cells.queue", count=waiting) if waiting else ""


def progress(rows: list[Row], statuses: dict[str, str]) -> float:
    """The share of the steps of the work that are done; of the recovery's once that runs."""
    phases = [row for row in rows if row["name"] in PHASES]
    active = [row for row in phases if statuses.get(row["path"]) == RUNNING] or phases[:1]
    steps = [row["path"] for phase in active for row in rows if parent(row["path"]) == phase["path"]]
    done = sum(statuses.get(path) == SUCCESS for path in steps)
    return round(done / len(steps), 3) if steps else 0.0


def _tree(moment: Moment, cell: str, memory: TreeMemory) -> Face:
    names = [moment.words.say(row["name"]) for row in memory.rows]
    labels = [SIGNS.get(row["kind"], "") + name for name, row in zip(names, memory.rows, strict=True)]
    nodes = [
        {
            "path": row["path"],
            "name": name,
            "label": label,
            "kind": row["kind"],
            "about": _about(moment, row),
        }
        for name, label, row in zip(names, labels, memory.rows, strict=True)
    ]
    drawn = drawing(tuple(zip((row["path"] for row in memory.rows), labels, strict=True)))
    leaf = memory.leaf["path"] if memory.leaf else None
    found: Face = {f"tree/{cell}": {"task": memory.task, "nodes": nodes, **drawn}}
    for row in memory.rows:
        found[f"node/{cell}/{row['path']}"] = _node(moment, row, memory, leaf)
    return found


def _about(moment: Moment, row: Row) -> str:
    return row["description"] or moment.words.of("kind", row["kind"])


def _node(moment: Moment, row: Row, memory: TreeMemory, leaf: str | None) -> Row:
    words, status = moment.words, memory.statuses.get(row["path"], "idle")
    running = status == RUNNING and not memory.over
    return {
        "state": status,
        "word": words.of("status", status),
        "current": row["path"] == leaf,
        "feedback": words.say(row["feedback"]) if running and row["feedback"] else "",
        "failure": words.say(row["failure"]) if row["failure"] else "",
        "failed": status == FAILURE,
        "since": seconds(row["since_s"]) if running else "",
        "left": seconds(row["deadline_s"]) if running else "",
        "given": [[words.of("parameter", key), _value(value)] for key, value in row["parameters"].items()],
    }


def _value(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, list | tuple):
        return ", ".join(f"{each:.4g}" if isinstance(each, float) else str(each) for each in value)
    return str(value)


def _changes(moment: Moment, cell: str, memory: TreeMemory) -> Face:
    """The last statuses, the newest first."""
    last = list(memory.changes)[-SHOWN_CHANGES:][::-1]
    found: Face = {f"rows/changes.{cell}": [str(change.number) for change in last]}
    for change in last:
        texts = [clock(change.at), moment.words.say(change.name), moment.words.of("status", change.status)]
        found[f"row/changes.{cell}/{change.number}"] = {"state": change.status, "texts": texts}
    return found
