"""Memory of a cell's tree from snapshot to snapshot: py_trees forgets statuses that people want to see."""

from __future__ import annotations

from collections import deque
from copy import copy
from dataclasses import dataclass
from typing import Any

from arboleda.drawing.folding import folded
from arboleda.drawing.layout import parent
from arboleda.engine import RECOVERY
from arboleda.model.sentence import Sentence

IDLE, RUNNING, SUCCESS, FAILURE, HALTED = "idle", "running", "success", "failure", "halted"
SEEN = {"RUNNING": RUNNING, "SUCCESS": SUCCESS, "FAILURE": FAILURE}
CHANGES = 30  # kept of each cell

Row = dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class Change:
    """A step began or ended, at unix s; its end takes the place of its beginning."""

    number: int
    at: float
    path: str
    name: Sentence
    status: str


@dataclass(frozen=True, kw_only=True)
class EndedTree:
    """The tree of a task that has ended, and the final status of each node."""

    task: str
    rows: list[Row]
    statuses: dict[str, str]


class TreeMemory:
    """TreeMemory: the last tree of one cell with its rows, the status of each node, and its last changes."""

    def __init__(self) -> None:
        self.rows: list[Row] = []
        self.statuses: dict[str, str] = {}
        self.changes: deque[Change] = deque(maxlen=CHANGES)
        self.task: str | None = None
        self.over = True
        self._work: tuple[list[Row], dict[str, str]] | None = None  # before a recovery of its own
        self._steps: set[str] = set()
        self._leaves: set[str] = set()
        self._count = 0

    def see(self, cell: Row, tasks: list[Row], unix_s: float) -> EndedTree | None:
        """Take in a cell of a snapshot and the changes of its tasks; returns the tree that ended with one."""
        ended = None
        if not self.over and (not cell["tree"] or _task_of(cell) != self.task):
            ended = self._finish(cell, tasks, unix_s)
        if cell["tree"]:
            self._follow(cell, unix_s)
        return ended

    def copy(self) -> TreeMemory:
        """A copy that goes on by itself."""
        made = copy(self)
        made.statuses, made.changes = dict(self.statuses), self.changes.copy()
        return made

    @property
    def leaf(self) -> Row | None:
        """The deepest node that runs."""
        if self.over:
            return None
        running = [row for row in self.rows if row["status"] == "RUNNING"]
        return running[-1] if running else None

    def _follow(self, cell: Row, unix_s: float) -> None:
        rows = cell["tree"]
        if self.over or _shape(rows) != _shape(self.rows):
            self._work = None if self.over else self._work or (self.rows, self.statuses)
            self._show(rows, {})
            self.task = _task_of(cell)
        self.rows, self.over = rows, False
        names = {row["path"]: row["name"] for row in rows}
        for path, status in judged(rows, self.statuses).items():
            self._become(path, names[path], status, unix_s)

    def _finish(self, cell: Row, tasks: list[Row], unix_s: float) -> EndedTree | None:
        """Give the nodes that still ran their final status, as their tree has gone."""
        task = next((task for task in tasks if task["id"] == self.task), {})
        recovered = cell["state"] in ("idle", "execute")
        work, self._work = self._work, None
        if work is not None:
            # the task names a leaf of its work, not of this recovery
            self._conclude(task | {"failed_in": None}, unix_s, recovered=recovered)
            rows, statuses = work
            self._show(rows, statuses | _within(rows, self.statuses))
        self._conclude(task, unix_s, recovered=recovered)
        self.over = True
        if self.task is None:
            return None
        return EndedTree(task=self.task, rows=self.rows, statuses=dict(self.statuses))

    def _show(self, rows: list[Row], statuses: dict[str, str]) -> None:
        """Begin another tree, as far as it has come."""
        shown = folded(rows)
        inner = {parent(row["path"]) for row in shown}
        self.rows, self.statuses = rows, statuses
        self._steps, self._leaves = set(steps(shown)), {row["path"] for row in shown} - inner

    def _conclude(self, task: Row, unix_s: float, *, recovered: bool) -> None:
        after = self.statuses | {
            row["path"]: last_status(row, self.rows, task.get("state"), recovered=recovered)
            for row in self.rows
            if self.statuses.get(row["path"]) == RUNNING
        }
        if task.get("state") == "done":
            _fill(self.rows, after)
        self._blame(task, after)
        for row in self.rows:
            self._become(row["path"], row["name"], after.get(row["path"], IDLE), unix_s)

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

    def _become(self, path: str, name: Sentence, status: str, unix_s: float) -> None:
        is_shown = path in self._steps or (status == FAILURE and path in self._leaves)
        if is_shown and self.statuses.get(path, IDLE) != status:
            self._count += 1
            begun = [each for each in self.changes if each.path == path and each.status == RUNNING]
            for each in begun:
                self.changes.remove(each)
            now = Change(number=self._count, at=unix_s, path=path, name=name, status=status)
            self.changes.append(now)
        self.statuses[path] = status


def _task_of(cell: Row) -> str | None:
    return cell["task"]["id"] if cell["task"] else None


def _within(rows: list[Row], recovery: dict[str, str]) -> dict[str, str]:
    """The statuses of a recovery with a tree of its own, by the paths within the recipe's rows."""
    place = next((row["path"] for row in rows if row["phase"] == RECOVERY), None)
    moved = {place if path == "root" else f"{place}.{path}": status for path, status in recovery.items()}
    return {row["path"]: moved[row["path"]] for row in rows if row["path"] in moved}


def phases(rows: list[Row]) -> list[Row]:
    """The work and the recovery of a recipe; none of a tree that is built otherwise."""
    return [row for row in rows if row["phase"] is not None]


def steps(rows: list[Row]) -> list[str]:
    """The steps that people follow: those of the phases, else of the root; without their parts and frames."""
    above = {row["path"] for row in phases(rows)} or {"root"}
    found = []
    for row in rows:
        if parent(row["path"]) in above:
            above |= {row["path"]} if row["frame"] else set()
            found += [] if row["frame"] else [row["path"]]
    return found


def judged(rows: list[Row], before: dict[str, str]) -> dict[str, str]:
    """The status of each node now; one that py_trees has reset keeps its earlier status."""
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


def _fill(rows: list[Row], after: dict[str, str]) -> None:
    """Count every part of a sequence or parallel that succeeded as done, even if no snapshot saw it run."""
    kinds = {row["path"]: row["kind"] for row in rows}
    for path in kinds:
        above = parent(path)
        whole = above is not None and after.get(above) == SUCCESS and kinds[above] in ("sequence", "parallel")
        if whole and after.get(path, IDLE) == IDLE:
            after[path] = SUCCESS


def _reset(row: Row, was: str) -> str:
    if was in (IDLE, RUNNING) and row["failure"]:
        return FAILURE
    return HALTED if was == RUNNING else was


def last_status(row: Row, rows: list[Row], state: str | None, *, recovered: bool) -> str:
    """The final status of a node that still ran when its tree ended with the task in `state`."""
    if state == "done":
        return SUCCESS
    phases = {each["path"]: each["phase"] for each in rows}
    way = [row["path"], *ancestors(row["path"])]
    if recovered and any(phases[path] == RECOVERY for path in way):
        return SUCCESS
    return FAILURE if row["path"] == "root" and state == "failed" else HALTED


def ancestors(path: str) -> list[str]:
    """The paths from a node's parent up to the root."""
    above = parent(path)
    return [] if above is None else [above, *ancestors(above)]


def _shape(rows: list[Row]) -> list[tuple[str, Sentence]]:
    return [(row["path"], row["name"]) for row in rows]
