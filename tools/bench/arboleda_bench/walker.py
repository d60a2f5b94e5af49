"""Walker through one cell's steps, one after the other, task after task: the common part of the floors."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Sequence
from typing import Generic, TypeVar

Step = TypeVar("Step")


class Walker(Generic[Step]):
    """Publishes the steps in order; a subclass says how, and calls `go_on` when a step is over."""

    def __init__(self, steps: Sequence[Step], pause_s: float) -> None:
        self._steps = steps
        self._pause_s = pause_s
        self._left: deque[Step] = deque()
        self._tasks = 0

    def publish(self, step: Step) -> None:
        raise NotImplementedError

    def task(self) -> None:
        """Add one task to be done."""
        self._tasks += 1
        if self._tasks == 1:
            self._begin()

    def go_on(self) -> None:
        """Publish the next step; after the last one, begin the next task."""
        if self._left:
            self.publish(self._left.popleft())
            return
        self._tasks -= 1
        if self._tasks:
            self._begin()

    def go_on_after(self, seconds: float) -> None:
        threading.Timer(seconds, self.go_on).start()

    def _begin(self) -> None:
        self._left.extend(self._steps)
        self.go_on_after(self._pause_s)
