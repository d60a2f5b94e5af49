"""Record of each robot of a cell that gets into shared zones: how long it waits for them, how it recovers.

`recovery_takes_its_zones` finds by it a recovery from an unknown place that is planned as from home.
"""

from __future__ import annotations

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.engine import CellRun, TakeZones
from arboleda.model.cell_states import CellState
from arboleda.model.plant_model import Workspace

from .commands import SentCommand

PAUSED = (CellState.HOLDING, CellState.HELD)


class ZoneUser:
    """One robot of a cell, in one start of the plant.

    `waited_s` is how long it has waited for its zones in the cell's own time since it asked for them, for a
    recovery only since all before it were at work; `behind_work`: those were at work when it last waited.
    `moves` are those of the recovery that runs, or ran last; `held_before`: it held zones when that began.
    `holds`: it held zones after the last step.
    """

    def __init__(self, cell: str, space: Workspace, run: CellRun) -> None:
        self.cell = cell
        self.space = space
        self.robot = space.robot.name
        self.run = run
        self.waited_s = 0.0
        self.behind_work = False
        self.holds = self.held_before = False
        self.moves: list[SentCommand] = []
        self._recovering: Behaviour | None = None
        self._waiter: TakeZones | None = None
        self._asked_at: float | None = None  # the cell's time at which the waiter began

    def wait(self, seconds: float, *, state: CellState, behind_work: bool) -> None:
        """Count the time that it waits for zones; `seconds` passed since the step before, in which its cell
        was in this `state`.

        For a recovery the time does not count while those before it are at work, before this step or after.
        """
        tree, waiter = self.run.tree, self._waiter
        if waiter is None or not _runs(waiter, tree):
            waiting = (leaf for leaf in running(tree) if isinstance(leaf, TakeZones))
            waiter = next((leaf for leaf in waiting if leaf.robot == self.robot), None)
        recovers = waiter is not None and waiter.recovers
        # what repeats a step has it ask anew, maybe in the step in which it gave up; a recovery waits on
        asked_at = waiter.began if waiter is not None and not recovers else None
        was_behind, self.behind_work = self.behind_work, behind_work
        waits_on = recovers and (behind_work or was_behind)
        if waits_on or (waiter, asked_at) != (self._waiter, self._asked_at):
            self._waiter, self._asked_at, self.waited_s = waiter, asked_at, 0.0
        elif state not in PAUSED:
            self.waited_s += seconds

    def watch_recovery(self, moves: list[SentCommand]) -> None:
        """Note the moves that its tree has sent it, if that is in a recovery."""
        if not self.run.run.recovering:
            self._recovering = None
        elif self._recovering is not self.run.tree:
            self._recovering, self.held_before = self.run.tree, self.holds
            self.moves = []
        self.moves += [each for each in moves if each.robot == self.robot]


def running(tree: Behaviour | None) -> list[Behaviour]:
    """The leaves of a tree that run, in its order."""
    leaves: list[Behaviour] = []
    nodes = [tree] if tree else []
    while nodes:
        node = nodes.pop()
        if node.status is Status.RUNNING:
            nodes += reversed(node.children)
            leaves += () if node.children else (node,)
    return leaves


def _runs(leaf: Behaviour, tree: Behaviour | None) -> bool:
    """True if a leaf runs in this tree."""
    node: Behaviour | None = leaf
    while node is not None and node.status is Status.RUNNING:
        if node is tree:
            return True
        node = node.parent
    return False
