"""Queue and history of the tasks."""

from __future__ import annotations

from typing import Any

from . import Face
from .moment import Moment, dated, seconds

ORDER = {"running": 0, "queued": 1}  # the rest has ended
Row = dict[str, Any]


def face(moment: Moment) -> Face:
    tasks = sorted_tasks(moment.snapshot["tasks"])
    found: Face = {"rows/tasks": [task["id"] for task in tasks]}
    for task in tasks:
        found[f"row/tasks/{task['id']}"] = _row(moment, task)
    open_ones = [task for task in tasks if task["state"] in ORDER]
    found["text/tasks.open"] = [str(len(open_ones)) if open_ones else "", ""]
    return found


def sorted_tasks(tasks: list[Row]) -> list[Row]:
    """The tasks in the order of the list: running ones, waiting ones, then ended ones, the last first."""
    open_ones = [task for task in tasks if task["state"] in ORDER]
    ended = [task for task in tasks if task["state"] not in ORDER]
    return [
        *sorted(open_ones, key=lambda task: ORDER[task["state"]]),
        *sorted(ended, key=lambda task: task["ended_at"], reverse=True),
    ]


def _row(moment: Moment, task: Row) -> Row:
    words = moment.words
    starts_and_ends = (task["started_at"], task["ended_at"])
    times = ["" if at is None else dated(moment.unix(at), moment.unix_s) for at in starts_and_ends]
    return {
        "state": task["state"],
        "cell": task["cell"],
        "texts": [
            words.of("task_state", task["state"]),
            task["text"],
            *times,
            seconds(task["elapsed_s"]),
            why(moment, task),
            f"#{task['id']}",
        ],
        "link": {"column": 1, "to": {"tab": "tasks", "task": task["id"]}},
        "acts": _acts(words, task),
        "heard": len(task["answers"]),
    }


def why(moment: Moment, task: Row) -> str:
    """The reason for which a task failed or waits, or the result of it that nobody confirmed."""
    words = moment.words
    if task["reason"]:
        return f"{words.of('reason', task['reason'])}: {words.say(task['sentence'])}"
    if task["state"] == "queued":
        cell = next(each for each in moment.snapshot["cells"] if each["name"] == task["cell"])
        return words.say(cell["waiting_for"]) if cell["waiting_for"] else ""
    return words.say(task["sentence"])


def _acts(words: Any, task: Row) -> list[Row]:
    if task["state"] in ORDER:
        asks = words.asks("cancel") if task["state"] == "running" else []
        offer = {"act": "cancel", "of": task["id"], "label": words("tasks.cancel")}
        return [{**offer, "does": words("does.cancel"), "asks": asks}]
    if task["state"] in ("failed", "cancelled"):
        does = words("tasks.retry_does", text=task["text"])
        return [{"act": "submit", "of": task["text"], "label": words("tasks.retry"), "does": does}]
    return []
