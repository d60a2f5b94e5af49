"""Time of one cell, which stands still while the cell is held, and the alarm clock of its tree."""

from __future__ import annotations

import math
from typing import Protocol

LEAST_S = 0.01
"""Shortest pause before a further try or round: a tree is ticked only so often at one instant."""


class Clock(Protocol):
    """The plant's time."""

    now: float
    """s; it never stands still."""


class CellTime:
    """Clock of a cell. It stands while the cell is held, so that no wait of its tree runs out meanwhile.

    `wakes` are when the tree is to be ticked again, s of `now`. `next_deadline` is the first of them, s of
    the plant's time; None while the cell is held.
    """

    def __init__(self, clock: Clock) -> None:
        self.wakes: list[float] = []
        self.next_deadline: float | None = None
        self.paused_s = 0.0  # how long the cell was held in all, but for a hold that lasts
        self._clock = clock
        self._paused_at: float | None = None

    @property
    def now(self) -> float:
        """The cell's time, s."""
        at = self._clock.now if self._paused_at is None else self._paused_at
        return at - self.paused_s

    @property
    def plant_now(self) -> float:
        """The plant's time, s; it never stands still."""
        return self._clock.now

    def pause(self, at: float | None = None) -> None:
        """Let the cell's time stand from now on, or from `at`, s of the plant's time."""
        if self._paused_at is None:
            self._paused_at = self._clock.now if at is None else at
            self._plan()

    def go_on(self) -> None:
        """Let the cell's time pass again."""
        if self._paused_at is not None:
            self.paused_s += self._clock.now - self._paused_at
            self._paused_at = None
            self._plan()

    def woken(self) -> bool:
        """Take the wakes that are due; True where there was one. None is due while the cell is held."""
        if self.next_deadline is None or min(self.wakes) > self.now:
            return False
        now = self.now
        self.wakes = [at for at in self.wakes if at > now]
        self._plan()
        return True

    def wake_at(self, at: float) -> None:
        """Have the tree ticked again at `at`, s of `now`."""
        self.wakes.append(at)
        self._plan()

    def forget_wakes(self) -> None:
        """Drop the wakes of the last tree."""
        self.wakes = []
        self._plan()

    def _plan(self) -> None:
        """Work out the next deadline, rounded up: a plant that wakes too early would find nothing due."""
        if self._paused_at is not None or not self.wakes:
            self.next_deadline = None
            return
        at = min(self.wakes)
        self.next_deadline = at + self.paused_s
        while self.next_deadline - self.paused_s < at:
            self.next_deadline = math.nextafter(self.next_deadline, math.inf)
