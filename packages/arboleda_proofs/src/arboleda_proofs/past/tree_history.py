"""The trees of the cells as they stood at any moment of a record."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from arboleda.dashboard import tree_memory
from arboleda_proofs.playback.cell_history import CellMoment

from .moments import BESIDE_NS, nanoseconds

JUST_NS = 2 * BESIDE_NS  # before a run's beginning, so that the beginning counts as a change
KEPT = 30  # tasks whose changes are kept, those that were asked for last

Row = dict[str, Any]


Follow = Callable[[str, int, int], Iterable[CellMoment]]


@dataclass
class Run:
    """A cell from the beginning of a task up to that of the next one; `looked` at as far as `until_ns`."""

    cell: str
    task: str | None
    began_ns: int
    until_ns: int
    next_ns: int | None = None
    looked: list[CellMoment] = field(default_factory=list)


@dataclass
class TreeState:
    """A tree that has followed the first `count` changes of a run, the last of them at `at_ns`."""

    run: Run
    memory: tree_memory.TreeMemory
    count: int = 0
    at_ns: int = 0

    def see(self, looked: Iterable[CellMoment]) -> None:
        """Follow the changes up to a moment; those that it has followed already are skipped."""
        for each in [*looked][self.count :]:
            self.memory.see(each.cell, each.tasks, each.unix_ns / 1e9)
            self.count, self.at_ns = self.count + 1, each.unix_ns


class TreeHistory:
    """TreeHistory: follows all that a task did up to a moment, as the state of each node depends on it.

    `follow(cell, after_ns, until_ns)` has each change of a cell in that time; `events` are the time line.
    """

    def __init__(self, follow: Follow, events: Sequence[Row], cells: Iterable[str], began_ns: int) -> None:
        self._follow = follow
        self._runs = {cell: _runs(events, cell, began_ns) for cell in cells}
        self._kept: list[Run] = []
        self._coming: dict[str, TreeState] = {}

    def at(self, cell: str, at_ns: int, snapshot: Row) -> tree_memory.TreeMemory:
        """The tree of a cell; the snapshot is that of the moment."""
        memory = self._come(cell, at_ns).memory.copy()
        row = next(each for each in snapshot["cells"] if each["name"] == cell)
        memory.see(row, snapshot["tasks"], at_ns / 1e9)
        return memory

    def _come(self, cell: str, at_ns: int) -> TreeState:
        """The tree of a cell at a moment, followed on from its last moment if that lies on the way."""
        run, come = self._run(cell, at_ns), self._coming.get(cell)
        if come is None or come.run is not run or come.at_ns > at_ns:
            come = self._coming[cell] = TreeState(run, tree_memory.TreeMemory())
        come.see(self._looked(run, at_ns))
        return come

    def ended(self, task: str, at_ns: int) -> tree_memory.EndedTree | None:
        """The tree of a task that had ended by then."""
        for run in (each for runs in self._runs.values() for each in runs if each.task == task):
            memory = tree_memory.TreeMemory()
            for looked in self._looked(run, at_ns):
                ended = memory.see(looked.cell, looked.tasks, looked.unix_ns / 1e9)
                if ended is not None and ended.task == task:
                    return ended
        return None

    def _run(self, cell: str, at_ns: int) -> Run:
        """The last run of a cell that had begun by then."""
        begun = bisect_right(self._runs[cell], at_ns, key=lambda run: run.began_ns)
        return self._runs[cell][max(0, begun - 1)]

    def _looked(self, run: Run, at_ns: int) -> Iterator[CellMoment]:
        """The changes of a run up to a moment, read from the record as far as they are new."""
        upto_ns = at_ns if run.next_ns is None else min(at_ns, run.next_ns)
        if upto_ns > run.until_ns:
            run.looked += self._follow(run.cell, run.until_ns, upto_ns)
            run.until_ns = upto_ns
        self._keep(run)
        return (looked for looked in run.looked if looked.unix_ns <= at_ns)

    def _keep(self, run: Run) -> None:
        self._kept = [each for each in self._kept if each is not run] + [run]
        for old in self._kept[:-KEPT]:
            old.looked, old.until_ns = [], old.began_ns - JUST_NS
        self._kept = self._kept[-KEPT:]


def _runs(events: Sequence[Row], cell: str, began_ns: int) -> list[Run]:
    """The tasks that a cell began, in order; first the one that it was at when the record began."""
    found = [Run(cell, None, began_ns, began_ns - JUST_NS)]
    for each in events:
        if each["kind"] == "task" and each["cell"] == cell and each["what"] == "running":
            at_ns = nanoseconds(each["at"])
            found[-1].next_ns = at_ns - JUST_NS
            found.append(Run(cell, each["subject"], at_ns, at_ns - JUST_NS))
    return found
