"""A page of the tasks that the plant has kept, of earlier starts too."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from arboleda.store.task_rows import TaskRow, sentence_of

from ..wording import Words
from . import Face
from .moment import dated, seconds


def face(rows: Sequence[TaskRow], words: Words, now_unix_s: float) -> Face:
    """The rows in their order; their list is the browser's, which may have the pages before."""
    return {f"row/history/{row.number}": _row(row, words, now_unix_s) for row in rows}


def _row(row: TaskRow, words: Words, now_unix_s: float) -> dict[str, Any]:
    accepted, ended = ("" if at is None else dated(at, now_unix_s) for at in (row.accepted_s, row.ended_s))
    asked_by = words.of("asked_by", row.asked_by) if row.asked_by else ""
    took_s = None if row.started_s is None or row.ended_s is None else row.ended_s - row.started_s
    return {
        "state": row.state,
        "cell": row.cell,
        "texts": [
            words.of("task_state", row.state),
            row.text,
            accepted,
            asked_by,
            ended,
            seconds(took_s),
            str(row.attempts or ""),
            _why(row, words),
            f"#{row.id}",
        ],
        "link": {"column": 1, "to": {"tab": "tasks", "task": row.id}},
    }


def _why(row: TaskRow, words: Words) -> str:
    sentence = words.say(sentence_of(row))
    return sentence if row.reason is None else f"{words.of('reason', row.reason)}: {sentence}"
