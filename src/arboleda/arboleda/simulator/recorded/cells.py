"""Record of each cell after its last step, and of the leaves that run in it."""

from __future__ import annotations

import math
from collections.abc import Container, Iterator
from operator import attrgetter
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.core.cell import CellRun
from arboleda.core.cell_states import CellState
from arboleda.model.plant_model import Cell, Timing
from arboleda.recipes.storage_layout import StorageLayout
from arboleda.trees.leaves import Act, TakeZones

from .commands import SentCommand
from .starts import turn_of

LOOK_S = 1.0  # a tree that sends nothing is looked through this often
PAUSED = (CellState.HOLDING, CellState.HELD)


class KnownCell:
    """A cell as it was after the last step; `stopped` outlives the plant: it lasts from stop to reset.

    `leaves` are those that run; `looked`: they were looked up in this step. `sends` counts the commands of
    each leaf of the tree in each turn of what repeats it, `again` how often an operator had an interrupted
    step given anew, `retries` how often one had a step tried again, over all starts. `waited_s` is how long
    the arm has waited for its zones in the cell's own time since it asked for them, for a recovery only since
    all before it were at work; `behind_work`: those were at work when it last waited. `frozen_s` is how much
    of that time did not pass since the last news although the cell was not held, `ran_s` how much did pass
    although it was held at work, also of what passed at once as it went on.
    """

    signs = attrgetter("state", "run.tree", "task", "queue.paused")

    def __init__(self, cell: Cell, timing: Timing) -> None:
        self.cell, self.timing = cell, timing
        self.timing_before = timing  # before this step
        self.layout = StorageLayout(cell)
        self.name = cell.name
        self.stopped = False
        self.retries = 0

    def revise(self, cell: Cell, timing: Timing) -> None:
        """Go by another version, which the cell has taken in this step."""
        self.cell, self.timing = cell, timing
        self.layout = StorageLayout(cell)

    def begin(self, run: CellRun) -> None:
        """Begin anew with a plant that starts."""
        self.run, self.context = run, run.context
        self.tree: Behaviour | None = None
        self.sends: dict[tuple[Behaviour, str], int] = {}
        self.again = 0
        self.holds_zones = False  # after the last step
        self.held_before_recovery = False
        self.recovery_moves: list[SentCommand] = []  # of the recovery that runs, or ran last
        self._recovering: Behaviour | None = None
        self.leaves: list[Any] = []
        self.looked = False
        self.waited_s = 0.0
        self.behind_work = False
        self.frozen_s = self.ran_s = 0.0
        self._held_at: float | None = None
        self._lag_s = math.inf
        self._waiter: Behaviour | None = None
        self._asked_at: float | None = None  # the cell's time at which the waiter began
        self.wakes = self.context.time.wakes
        self.follow()

    def follow(self) -> None:
        """Take over the present state of the cell, of which `signs` got another one than `last_signs`, or
        in whose queue is another number of tasks.
        """
        run = self.run
        self.last_signs = self.state, tree, self.task, self.paused = self.signs(run)
        self.queued = len(run.queue)
        if tree is not self.tree:
            self.tree = tree
            self.sends.clear()
            self.again = 0

    def changes(self) -> Iterator[str]:
        """Sentences on what is not as it was after the last step."""
        run = self.run
        if run.state is not self.state:
            yield f"{self.name} went from {self.state.value} to {run.state.value}"
        if (run.queue.paused, len(run.queue)) != (self.paused, self.queued):
            yield f"the queue of {self.name} changed"
        if run.task is not self.task or run.tree is not self.tree:
            yield f"the task of {self.name} changed"

    def woke(self) -> bool:
        """True if a time for which its tree waited after the last step has come."""
        now = self.context.time.now
        return any(at <= now for at in self.wakes)

    def wait(self, seconds: float, *, behind_work: bool) -> None:
        """Count the time that its arm waits for zones; `seconds` passed since the step before.

        For a recovery the time does not count while those before it are at work.
        """
        tree, waiter = self.run.tree, self._waiter
        if waiter is None or not _runs(waiter, tree):
            waiter = next((leaf for leaf in _running(tree) if isinstance(leaf, TakeZones)), None)
        recovers = isinstance(waiter, TakeZones) and waiter.recovers
        # what repeats a step has it ask anew, maybe in the step in which it gave up; a recovery waits on
        asked_at = waiter.began if isinstance(waiter, TakeZones) and not recovers else None
        self.behind_work = behind_work
        if (waiter, asked_at) != (self._waiter, self._asked_at) or (recovers and behind_work):
            self._waiter, self._asked_at, self.waited_s = waiter, asked_at, 0.0
        elif self.state not in PAUSED:
            self.waited_s += seconds

    def watch_time(self, now: float, *, away: bool = False) -> None:
        """Compare the cell's own time with the plant's: it may fall behind only while the cell is held.

        Where the plant was `away`, that time does not pass for a cell at work.
        """
        own, before = self.context.time.now, self._held_at
        lag_s = now - own
        self.frozen_s = 0.0 if away else max(lag_s - self._lag_s, 0.0)
        self._lag_s = math.inf if self.state in PAUSED else lag_s
        self._held_at = own if self.state in PAUSED and self.tree is not None else None
        self.ran_s = 0.0 if before is None or self.tree is None else own - before

    def watch_recovery(self, moves: list[SentCommand]) -> None:
        """Note the moves of its arm that its tree has sent, if it is in a recovery."""
        if not self.run.run.recovering:
            self._recovering = None
        elif self._recovering is not self.run.tree:
            self._recovering, self.held_before_recovery = self.run.tree, self.holds_zones
            self.recovery_moves = []
        self.recovery_moves += moves

    def look(self, sent: Container[str]) -> None:
        """Look up the leaves that run, and count the commands of this step, by id, that are theirs."""
        self.looked = True
        self.leaves = _running(self.run.tree)
        for leaf in self.leaves:
            if isinstance(leaf, Act) and leaf.entry is not None and leaf.entry.command.id in sent:
                turn = leaf, turn_of(leaf)
                self.sends[turn] = self.sends.get(turn, 0) + 1


def _runs(leaf: Behaviour, tree: Behaviour | None) -> bool:
    """True if a leaf runs in this tree."""
    node: Behaviour | None = leaf
    while node is not None and node.status is Status.RUNNING:
        if node is tree:
            return True
        node = node.parent
    return False


def _running(tree: Behaviour | None) -> list[Behaviour]:
    """The leaves of a tree that run, in its order."""
    leaves: list[Behaviour] = []
    nodes = [tree] if tree else []
    while nodes:
        node = nodes.pop()
        if node.status is Status.RUNNING:
            nodes += reversed(node.children)
            leaves += () if node.children else (node,)
    return leaves
