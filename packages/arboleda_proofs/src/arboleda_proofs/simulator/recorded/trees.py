"""Looks into the trees of cells at work: who sends something, and from time to time all.

`retries_bounded` finds by it a step that is tried once more than allowed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from arboleda.drivers import Command
from arboleda.engine import Act
from arboleda.model.cell_states import CellState
from arboleda.rig.world import World

from .cells import LOOK_S, KnownCell
from .commands import SentCommand
from .starts import Starts, Step, turn_of


class Trees:
    """Has each cell look up its leaves, and `starts` know the steps that gave commands."""

    def __init__(self, world: World, starts: Starts) -> None:
        self._world = world
        self._starts = starts
        self._look_again_at = 0.0
        self.begin()

    def begin(self) -> None:
        """Begin with a plant that starts."""
        self._start = self._world.plant_process.starts

    def is_due(self, now: float) -> bool:
        """True if it is time to look into all trees."""
        return now >= self._look_again_at

    def look(self, cells: Iterable[KnownCell], now: float, new: list[SentCommand], *, away: bool) -> None:
        """Look into the trees of the cells that sent something, or into all if that is due."""
        due = self.is_due(now)
        if due:
            self._look_again_at = now + LOOK_S
        sent = {each.command.id: each.command for each in new}
        senders = {each.entry.cell for each in new if each.entry}
        for cell in cells:
            cell.watch_time(now, away=away)
            if (due or cell.name in senders) and cell.state is CellState.EXECUTE:
                self.look_into(cell, sent)

    def look_into(self, cell: KnownCell, sent: Mapping[str, Command]) -> None:
        """Look up the leaves of a cell, and note the steps of its task that gave commands in this step."""
        cell.look(sent)
        run, start = cell.run, self._start
        if run.task is None or run.run.recovering:
            return
        for leaf in cell.leaves:
            entry = leaf.entry if isinstance(leaf, Act) else None
            command = None if entry is None else sent.get(entry.command.id)
            if command is not None:
                board = self._world.model.robots[command.robot].mqtt
                misled = self._world.deceptions[board, "ack"] > 0
                path = turn_of(leaf)
                self._starts.gave(Step(run.task.id, path, command, start, cell.retries, misled=misled))
