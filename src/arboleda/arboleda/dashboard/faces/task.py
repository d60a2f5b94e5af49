"""One task: how it stands or how it ended, and the tree of one that has ended."""

from __future__ import annotations

from typing import Any

from arboleda.store.task_rows import TaskRow, answers_of, choice_of, sentence_of

from ..tree_memory import EndedTree
from . import Face, answers
from .cells import failed_in, remark, tree_face
from .moment import Moment, dated, seconds
from .tasks import why

TREE = "#task"  # no cell is called so
Row = dict[str, Any]


def face(moment: Moment, id: str, tree: EndedTree | None, kept: TaskRow | None = None) -> Face:
    """The page of a task: a kept one if no screen shows it any more; an unknown one has only its name."""
    task = next((task for task in moment.snapshot["tasks"] if task["id"] == id), None)
    is_past = task is None and kept is not None
    if task is None and kept is not None:
        task = _past(moment, kept)
    words = moment.words
    if task is None:
        title, state, when, cause, tone = f"#{id}", ["", ""], "", "", ""
    else:
        title, state = f"{task['text']} #{id}", [words.of("task_state", task["state"]), task["state"]]
        when, cause = _when(moment, task), _cause(moment, task, tree)
        tone = "warning" if remark(words, task) else task["state"]
    is_chaptered = id in moment.snapshot.get("chapters", ())
    report = "report.link" if state[1] == "failed" else "report.chapters" if is_chaptered else ""
    return {
        "text/task.title": [title, ""],
        "text/task.state": state,
        "text/task.when": [when, ""],
        "text/task.cause": [cause, tone],
        "text/task.choice": [_choice(moment, task), ""],
        "text/task.note": [words("task.past") if is_past else _note(moment, task, tree), ""],
        "text/task.record": [words("record.look") if _ended_here(task, kept=is_past) else "", ""],
        "text/task.report": [words(report), id] if report else ["", ""],
        **answers.rows(words, "task.heard", task["answers"] if task else []),
        **tree_face(words, TREE, tree or EndedTree(task=id, rows=[], statuses={}), title=title),
    }


def _ended_here(task: Row | None, *, kept: bool) -> bool:
    """True if a task ended in this start and its record is therefore complete."""
    return task is not None and not kept and task["ended_at"] is not None


def _past(moment: Moment, kept: TaskRow) -> Row:
    """A task as it was kept, like one of the plant; its times are on the plant's clock."""
    back_s = moment.snapshot["at"] - moment.unix_s
    times = [None if at is None else at + back_s for at in (kept.started_s, kept.ended_s)]
    started, ended = times
    return {
        "id": kept.id,
        "text": kept.text,
        "cell": kept.cell,
        "state": kept.state,
        "reason": kept.reason,
        "sentence": sentence_of(kept),
        "failed_in": None,
        "elapsed_s": None if started is None or ended is None else ended - started,
        "started_at": started,
        "ended_at": ended,
        "answers": [vars(each) for each in answers_of(kept)],
        "choice": choice_of(kept),
    }


def _when(moment: Moment, task: Row) -> str:
    both = (task["started_at"], task["ended_at"])
    times = [dated(moment.unix(at), moment.unix_s) for at in both if at is not None]
    took = seconds(task["elapsed_s"]) if task["ended_at"] is not None else ""
    return " · ".join(part for part in (task["cell"], " - ".join(times), took) if part)


def _cause(moment: Moment, task: Row, tree: EndedTree | None) -> str:
    if task["state"] == "failed" and tree is not None:
        return failed_in(moment.words, task, tree.rows)
    return why(moment, task)


def _choice(moment: Moment, task: Row | None) -> str:
    """The reason for which this cell was chosen for the task; empty in records of older versions."""
    choice = task.get("choice") if task is not None else None
    return moment.words("task.choice", why=moment.words.say(choice)) if choice else ""


def _note(moment: Moment, task: Row | None, tree: EndedTree | None) -> str:
    """The note that stands in place of a tree that cannot be shown."""
    if task is None:
        return moment.words("task.unknown")
    if tree is not None:
        return ""
    if task["ended_at"] is None:
        return moment.words("task.running" if task["started_at"] is not None else "task.waiting")
    return moment.words("task.no_tree")
