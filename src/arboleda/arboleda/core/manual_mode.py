"""Manual mode of a cell: pauses its queue while somebody teaches it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from arboleda.model.sentence import Phrase, Sentence

from .teaching import Teaching

if TYPE_CHECKING:
    from .cell import CellRun

NOT_TOUCHED = Phrase("teach.not_touched", "nobody touched it for {seconds:g} s")


class ManualMode:
    """Manual mode of one cell; `teaching` is what its teacher does, None while nobody teaches it.

    `when_over` is called each time it has ended, with the reason.
    """

    def __init__(self, run: CellRun) -> None:
        self._run = run
        self.teaching: Teaching | None = None
        self.when_over: Callable[[CellRun, Teaching, Sentence], None] = lambda run, teaching, why: None

    def begin(self, teaching: Teaching) -> None:
        """Begin it: the queue pauses, and no task starts before the end of it."""
        run = self._run
        run.queue.paused = True
        for robot in filter(run.context.devices.has, run.cell.zone_users):
            run.context.zones.claim_free(robot)
        self.teaching, run.dirty = teaching, True

    def end(self, why: Sentence) -> None:
        """End it; what moves is halted."""
        teaching, self.teaching = self.teaching, None
        if teaching is not None:
            teaching.end()
            self.when_over(self._run, teaching, why)
            self._run.dirty = True

    def go_on(self) -> bool:
        """Go on with what its teacher holds, or end it where nobody touches it; whether anything was done."""
        if self.teaching is None:
            return False
        if self.teaching.is_forgotten:
            self.end(NOT_TOUCHED(seconds=self._run.cell.teach.ends_after_s))
            return True
        return self.teaching.look()
