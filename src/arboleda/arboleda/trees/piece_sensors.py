"""Piece sensors of a cell's robots, debounced."""

from __future__ import annotations

from collections.abc import Mapping

from arboleda.dispatch.belief import Belief
from arboleda.model.plant_model import Timing

from .cell_time import CellTime


class PieceSensors:
    """Reader of the piece sensors; `awaited`: a tree waits for a newer report of one."""

    def __init__(self, beliefs: Mapping[str, Belief], timing: Timing, time: CellTime) -> None:
        self.awaited = False
        self._beliefs = beliefs
        self._debounce_s = timing.piece_debounce_s
        self._time = time

    def revise(self, timing: Timing) -> None:
        """Go by other times from now on."""
        self._debounce_s = timing.piece_debounce_s

    def read(self, robot: str, since: float) -> bool | None:
        """The debounced report of a robot's piece sensor since `since`, s of the cell's time; else None."""
        belief, paused_s = self._beliefs[robot], self._time.paused_s
        fresh = belief.robot.piece_on_change or belief.piece_at - paused_s >= since
        self.awaited = self.awaited or not fresh  # a change of a fresh report wakes the tree anyway
        if belief.piece is None or not (belief.senses_pieces and belief.online and fresh):
            return None
        settled_at = belief.piece_since + self._debounce_s - paused_s
        if self._time.now < settled_at:
            self._time.wake_at(settled_at)
            return None
        return belief.piece
