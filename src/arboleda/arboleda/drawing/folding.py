"""Trees as people see them: the small steps that every task has are shown by their parent."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from arboleda.model.sentence import Sentence

from .layout import parent

Row = dict[str, Any]
SMALL = frozenset({"step.announce", "step.dwell", "step.settle", "step.switch"})
TOLD = ("feedback", "failure", "since_s", "deadline_s")  # by a parent that has none of its own


def folded(rows: Sequence[Row]) -> list[Row]:
    """The rows without small steps: a parent says what the one says that runs or has failed.

    A parent of small steps alone is a leaf of the kind of its first one.
    """
    inside = small_steps(rows)
    shown = [row for row in rows if not is_small(row)]
    inner = {parent(row["path"]) for row in shown}
    return [
        _with(row, inside[row["path"]], is_leaf=row["path"] not in inner) if row["path"] in inside else row
        for row in shown
    ]


def small_steps(rows: Sequence[Row]) -> dict[str | None, list[Row]]:
    """The small steps below each node that has some, by its path."""
    found: dict[str | None, list[Row]] = {}
    for row in rows:
        if is_small(row):
            found.setdefault(parent(row["path"]), []).append(row)
    return found


def is_small(row: Row) -> bool:
    """True for a step of ours that is shown by its parent."""
    name = row["name"]
    return isinstance(name, Sentence) and name.key in SMALL and parent(row["path"]) is not None


def shown_at(path: str, rows: Sequence[Row]) -> str:
    """The path of the node that shows the node at `path`."""
    above = parent(path)
    return above if above and any(row["path"] == path and is_small(row) for row in rows) else path


def _with(row: Row, inside: Sequence[Row], *, is_leaf: bool) -> Row:
    runs = (each for each in inside if each["status"] == "RUNNING")
    failed = (each for each in inside if each.get("failure"))
    said = next(runs, next(failed, {}))
    told: Row = {
        key: said.get(key) for key in TOLD if key in row and not row[key] and said.get(key) is not None
    }
    first: Row = {key: inside[0][key] for key in ("kind", "parameters") if is_leaf and key in row}
    return {**row, **told, **first}
