"""Work in short slices, for a thread that has more urgent things to do."""

from __future__ import annotations

import math
import time
from collections.abc import Generator
from typing import Generic, TypeVar

SLICE_S = 0.0003  # processor time of a slice; a part that is longer makes it longer
PAUSE_S = 0.001  # between two slices, in which other threads have the processor and Python's lock

Result = TypeVar("Result")


class Slices(Generic[Result]):
    """Slices: runs `parts` slice by slice; `result` is their result once all are done."""

    result: Result

    def __init__(self, parts: Generator[None, None, Result]) -> None:
        self._parts = parts
        self.over = False
        self.spent_s = 0.0  # of processor time so far
        self.due = -math.inf  # when the next slice may come, on the clock of `now`

    def cut(self, now: float) -> bool:
        """Run one slice; True if all is done. If a part raises, nothing more is done."""
        began = time.thread_time()
        spent_s = 0.0
        try:
            while spent_s < SLICE_S:
                next(self._parts)
                spent_s = time.thread_time() - began
        except StopIteration as end:
            self.over, self.result = True, end.value
        except BaseException:  # it goes on to the caller; a generator that raised has no next part
            self.over = True
            raise
        self.spent_s += time.thread_time() - began
        self.due = now + SLICE_S + PAUSE_S
        return self.over
