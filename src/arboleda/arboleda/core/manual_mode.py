"""Manual mode of a cell: pauses its queue while somebody teaches it."""

from __future__ import annotations

from collections.abc import Callable

from arboleda.model.sentence import Phrase, Sentence
from arboleda.trees.context import Context

from .task_queue import TaskQueue
from .teaching import Teaching

NOT_TOUCHED = Phrase("teach.not_touched", "nobody touched it for {seconds:g} s")


class ManualMode:
    """Manual mode of one cell; `teaching` is None while nobody teaches the cell.

    `when_over` is called with the reason each time that a teaching has ended.
    """

    def __init__(self, context: Context, queue: TaskQueue) -> None:
        self._context = context
        self._queue = queue
        self.teaching: Teaching | None = None
        self.when_over: Callable[[Teaching, Sentence], None] = lambda teaching, why: None

    def begin(self, teaching: Teaching) -> None:
        """Begin a teaching: the queue pauses, and no task starts before its end."""
        context = self._context
        self._queue.paused = True
        for robot in filter(context.devices.has, context.cell.zone_users):
            context.zones.claim_free(robot)
        self.teaching = teaching

    def end(self, why: Sentence) -> None:
        """End the teaching, and halt what moves."""
        teaching, self.teaching = self.teaching, None
        if teaching is not None:
            teaching.end()
            self.when_over(teaching, why)

    def go_on(self) -> bool:
        """Go on with the button that is held, or end a forgotten teaching; True where anything was done."""
        if self.teaching is None:
            return False
        if self.teaching.is_forgotten:
            self.end(NOT_TOUCHED(seconds=self._context.cell.teach.ends_after_s))
            return True
        return self.teaching.look()
