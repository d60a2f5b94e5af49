"""Record of each cell after its last step, and of the leaves that run in it.

`running_tree_has_waker` finds by it a dwell that does not ask to be woken.
"""

from __future__ import annotations

import math
from collections.abc import Container, Iterable, Iterator
from operator import attrgetter
from typing import Any

from py_trees.behaviour import Behaviour

from arboleda.engine import Act, CellRun
from arboleda.engine.inspection import time_of
from arboleda.model.cell_states import CellState
from arboleda.model.plant_model import Cell, Timing

from .starts import turn_of
from .zone_users import PAUSED, ZoneUser, running

Transition = tuple["KnownCell", CellState, CellState]  # a cell, its state before a step, and after
LOOK_S = 1.0  # a tree that sends nothing is looked through this often


class KnownCell:
    """A cell as it was after the last step; `stopped` outlives the plant: it lasts from stop to reset.

    `leaves` are those that run; `looked`: they were looked up in this step. `sends` counts the commands of
    each leaf of the tree in each turn of what repeats it, `again` how often an operator had an interrupted
    step given anew, `retries` how often one had a step tried again, over all starts. `frozen_s` is how much
    of its own time did not pass since the last news although the cell was not held, `ran_s` how much did pass
    although it was held at work, also of what passed at once as it went on. `zone_users` are its robots that
    get into shared zones, by name.
    """

    signs = attrgetter("state", "run.tree", "task", "queue.paused")

    def __init__(self, cell: Cell, timing: Timing) -> None:
        self.cell, self.timing = cell, timing
        self.name = cell.name
        self.stopped = False
        self.retries = 0

    def revise(self, cell: Cell, timing: Timing) -> None:
        """Go by another version, which the cell has taken in this step."""
        self.cell, self.timing = cell, timing
        for name, user in self.zone_users.items():
            user.space = cell.workspaces[name]

    def begin(self, run: CellRun) -> None:
        """Begin anew with a plant that starts."""
        self.run, self.time = run, time_of(run)
        self.tree: Behaviour | None = None
        self.sends: dict[tuple[Behaviour, str], int] = {}
        self.again = 0
        spaces = [self.cell.workspaces[name] for name in self.cell.zone_users]
        self.zone_users = {space.robot.name: ZoneUser(self.name, space, run) for space in spaces}
        self.leaves: list[Any] = []
        self.looked = False
        self.frozen_s = self.ran_s = 0.0
        self._held_at: float | None = None
        self._lag_s = math.inf
        self.wakes = self.time.wakes
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
        now = self.time.now
        return any(at <= now for at in self.wakes)

    def watch_time(self, now: float, *, away: bool = False) -> None:
        """Compare the cell's own time with the plant's: it may fall behind only while the cell is held.

        Where the plant was `away`, that time does not pass for a cell at work.
        """
        own, before = self.time.now, self._held_at
        lag_s = now - own
        self.frozen_s = 0.0 if away else max(lag_s - self._lag_s, 0.0)
        self._lag_s = math.inf if self.state in PAUSED else lag_s
        self._held_at = own if self.state in PAUSED and self.tree is not None else None
        self.ran_s = 0.0 if before is None or self.tree is None else own - before

    def look(self, sent: Container[str]) -> None:
        """Look up the leaves that run, and count the commands of this step, by id, that are theirs."""
        self.looked = True
        self.leaves = running(self.run.tree)
        for leaf in self.leaves:
            if isinstance(leaf, Act) and leaf.entry is not None and leaf.entry.command.id in sent:
                turn = leaf, turn_of(leaf)
                self.sends[turn] = self.sends.get(turn, 0) + 1


class CellStates:
    """Changes of cells in a step: `transitions` of their states; `idle`: cells with tasks in their queue,
    which is not paused.
    """

    def __init__(self, cells: Iterable[KnownCell]) -> None:
        self.transitions: list[Transition] = []
        self.idle: list[KnownCell] = []
        self._cells = tuple(cells)

    def look(self) -> bool:
        """Take over the states of the cells; True if any of them changed."""
        changed = False
        for cell in self._cells:
            cell.looked, run = False, cell.run
            cell.wakes = cell.time.wakes
            if cell.signs(run) == cell.last_signs and len(run.queue) == cell.queued:
                continue
            before, changed = cell.state, True
            cell.follow()
            if cell.state is not before:
                self.transitions.append((cell, before, cell.state))
        return changed

    def look_for_idle(self) -> None:
        idle = [cell for cell in self._cells if cell.queued and cell.state is CellState.IDLE]
        self.idle = [cell for cell in idle if not cell.paused]
