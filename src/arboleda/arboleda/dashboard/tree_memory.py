"""What a cell's tree did, from snapshot to snapshot: py_trees forgets statuses, people want to see them."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Any

from arboleda.drawing.layout import parent

IDLE, RUNNING, SUCCESS, FAILURE, HALTED = "idle", "running", "success", "failure", "halted"
SEEN = {"RUNNING": RUNNING, "SUCCESS": SUCCESS, "FAILURE": FAILURE}
CHANGES = 30  # kept of each cell
RECOVERY = "recovery"

Row = dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class Change:
    """A node got another status, at unix s."""

    number: int
    at: float
    name: str
    status: str


class TreeMemory:
    """The last tree of one cell: its rows, what each node came to, and the last changes."""

    def __init__(self) -> None:
        self.rows: list[Row] = []
        self.statuses: dict[str, str] = {}
        self.changes: deque[Change] = deque(maxlen=CHANGES)
        self.task: str | None = None
        self.over = True
        self._count = 0

    def see(self, cell: Row, tasks: list[Row], unix_s: float) -> None:
        """Take in a cell of a snapshot, and what became of its tasks."""
        if cell["tree"]:
            self._follow(cell, unix_s)
        elif not self.over:
            self._finish(cell, tasks, unix_s)

    @property
    def leaf(self) -> Row | None:
        """The deepest node that runs."""
        if self.over:
            return None
        running = [row for row in self.rows if row["status"] == "RUNNING"]
        return running[-1] if running else None

    def _follow(self, cell: Row, unix_s: float) -> None:
        rows, task = cell["tree"], cell["task"]["id"] if cell["task"] else None
        if self.over or task != self.task or _shape(rows) != _shape(self.rows):
            self.statuses, self.task = {}, task
        self.rows, self.over = rows, False
        names = {row["path"]: row["name"] for row in rows}
        for path, status in judged(rows, self.statuses).items():
            self._become(path, names[path], status, unix_s)

    def _finish(self, cell: Row, tasks: list[Row], unix_s: float) -> None:
        """The tree is gone: what ran in it came to the end of its task."""
        task = next((task for task in tasks if task["id"] == self.task), {})
        recovered = cell["state"] == "idle"
        after = self.statuses | {
            row["path"]: last_status(row, self.rows, task.get("state"), recovered=recovered)
            for row in self.rows
            if self.statuses.get(row["path"]) == RUNNING
        }
        self._blame(task, after)
        for row in self.rows:
            self._become(row["path"], row["name"], after[row["path"]], unix_s)
        self.over = True

    def _blame(self, task: Row, after: dict[str, str]) -> None:
        """Show the leaf that failed the task as failed, also where no snapshot said so in time."""
        leaf = task.get("failed_in")
        if leaf not in after:
            return
        self.rows = [row | {"failure": task["sentence"]} if row["path"] == leaf else row for row in self.rows]
        after[leaf] = FAILURE
        kinds = {row["path"]: row["kind"] for row in self.rows}
        for above in ancestors(leaf):
            if kinds[above] == "sequence":
                _conclude(above, list(kinds), after)

    def _become(self, path: str, name: str, status: str, unix_s: float) -> None:
        if self.statuses.get(path, IDLE) != status:
            self._count += 1
            self.changes.append(Change(number=self._count, at=unix_s, name=name, status=status))
        self.statuses[path] = status


def judged(rows: list[Row], before: dict[str, str]) -> dict[str, str]:
    """What each node has come to; one that py_trees reset keeps what it came to before."""
    after: dict[str, str] = {}
    for row in reversed(rows):  # children before their parents
        path, was = row["path"], before.get(row["path"], IDLE)
        after[path] = SEEN.get(row["status"]) or _reset(row, was)
        if row["kind"] == "sequence" and row["status"] == "INVALID":
            _conclude(path, [each["path"] for each in rows], after)
    return {row["path"]: after[row["path"]] for row in rows}


def _conclude(sequence: str, paths: list[str], after: dict[str, str]) -> None:
    """A sequence that was reset with a failed child has failed; what stands before that child was done."""
    children = [path for path in paths if parent(path) == sequence]
    failed = next((number for number, path in enumerate(children) if after[path] == FAILURE), None)
    if failed is None:
        return
    after[sequence] = FAILURE
    for child in children[:failed]:
        for path in paths:
            if after.get(path) == HALTED and (path == child or path.startswith(f"{child}.")):
                after[path] = SUCCESS


def _reset(row: Row, was: str) -> str:
    if was in (IDLE, RUNNING) and row["failure"]:
        return FAILURE
    return HALTED if was == RUNNING else was


def last_status(row: Row, rows: list[Row], state: str | None, *, recovered: bool) -> str:
    """What a node that ran came to when its tree ended with the task in `state`."""
    if state == "done":
        return SUCCESS
    names = {each["path"]: each["name"] for each in rows}
    way = [row["path"], *ancestors(row["path"])]
    if recovered and any(names[path] == RECOVERY for path in way):
        return SUCCESS
    return FAILURE if row["path"] == "root" and state == "failed" else HALTED


def ancestors(path: str) -> list[str]:
    """The paths from a node's parent up to the root."""
    above = parent(path)
    return [] if above is None else [above, *ancestors(above)]


def _shape(rows: list[Row]) -> list[tuple[str, str]]:
    return [(row["path"], row["name"]) for row in rows]
