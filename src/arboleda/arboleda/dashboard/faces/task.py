"""One task: how it stands or how it ended, and the tree of one that has ended."""

from __future__ import annotations

from typing import Any

from ..tree_memory import EndedTree
from . import Face
from .cells import failed_in, tree_face
from .moment import Moment, clock, seconds
from .tasks import why

TREE = "#task"  # no cell is called so
Row = dict[str, Any]


def face(moment: Moment, id: str, tree: EndedTree | None) -> Face:
    """Of a task that the plant knows no more only its name."""
    task = next((task for task in moment.snapshot["tasks"] if task["id"] == id), None)
    words = moment.words
    if task is None:
        title, state, when, cause = f"#{id}", ["", ""], "", ""
    else:
        title, state = f"{task['text']} #{id}", [words.of("task_state", task["state"]), task["state"]]
        when, cause = _when(moment, task), _cause(moment, task, tree)
    return {
        "text/task.title": [title, ""],
        "text/task.state": state,
        "text/task.when": [when, ""],
        "text/task.cause": [cause, state[1]],
        "text/task.note": [_note(moment, task, tree), ""],
        **tree_face(words, TREE, tree or EndedTree(task=id, rows=[], statuses={}), title=title),
    }


def _when(moment: Moment, task: Row) -> str:
    times = [clock(moment.unix(at)) for at in (task["started_at"], task["ended_at"]) if at is not None]
    took = seconds(task["elapsed_s"]) if task["ended_at"] is not None else ""
    return " · ".join(part for part in (task["cell"], " - ".join(times), took) if part)


def _cause(moment: Moment, task: Row, tree: EndedTree | None) -> str:
    if task["state"] == "failed" and tree is not None:
        return failed_in(moment.words, task, tree.rows)
    return why(moment, task)


def _note(moment: Moment, task: Row | None, tree: EndedTree | None) -> str:
    """Why there is no tree to look at."""
    if task is None:
        return moment.words("task.unknown")
    if tree is not None:
        return ""
    if task["ended_at"] is None:
        return moment.words("task.running" if task["started_at"] is not None else "task.waiting")
    return moment.words("task.no_tree")
