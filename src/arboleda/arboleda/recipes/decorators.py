"""Steps around steps: again after a failure, at most so long, instead of a failure.

They are woken by the plant's events and times; the decorators of py_trees ask a clock of their own.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.decorators import Decorator

from arboleda.model.messages import Failure, Reason
from arboleda.model.sentence import Phrase
from arboleda.trees.cell_time import CellTime
from arboleda.trees.context import Context
from arboleda.trees.failures import Failures
from arboleda.trees.leaves import title_of, titled
from arboleda.trees.trail import Keeps

RETRY = Phrase("step.retry", "retry {step}")
REPEAT = Phrase("step.repeat", "repeat {step}")
TIMEOUT = Phrase("step.timeout", "timeout {step}")
TRY = Phrase("step.forgive", "try {step}")
INVERT = Phrase("step.invert", "invert {step}")
TOO_LATE = Phrase("recipe.too_late", "{step} did not end within {seconds:g} s")
NOT_FAILED = Phrase("recipe.not_failed", "{step} was to fail, and did not")


class Around(Keeps, Decorator):
    """A step around another one, which is the step that screens name."""

    frame = True

    def __init__(self, phrase: Phrase, child: Behaviour) -> None:
        title = phrase(step=title_of(child))
        super().__init__(str(title), child)
        titled(self, title)


class Again(Around):
    """Does its step again, `times` more at most, after a pause: while it fails for one of `causes`."""

    def __init__(
        self, child: Behaviour, context: Context, *, times: int, pause_s: float, causes: Collection[Reason]
    ) -> None:
        super().__init__(RETRY, child)
        self.time, self.failures = context.time, context.failures
        self.times = times
        self.pause_s = pause_s
        self.causes = causes
        self.tries = 0
        self.again_at: float | None = None

    def initialise(self) -> None:
        self.tries, self.again_at = 0, None

    def kept(self) -> Mapping[str, Any] | None:
        return {"tries": self.tries} if self.status is Status.RUNNING else None

    def restore(self, state: Mapping[str, Any]) -> None:
        self.tries = state["tries"]

    def tick(self) -> Iterator[Behaviour]:
        if self.status is Status.RUNNING and self.again_at is not None:
            if self.time.now < self.again_at:
                yield self
                return
            self.again_at = None
        yield from super().tick()

    def update(self) -> Status:
        status, failure = self.decorated.status, self.failures.first
        spent = self.tries >= self.times or failure is None or failure.reason not in self.causes
        if status is not Status.FAILURE or spent:
            return status
        self.tries += 1
        self.failures.forgive()
        self.again_at = self.time.now + self.pause_s
        self.time.wake_at(self.again_at)
        return Status.RUNNING


class Times(Around):
    """Does its step `times` times, one after the other."""

    def __init__(self, child: Behaviour, time: CellTime, *, times: int) -> None:
        super().__init__(REPEAT, child)
        self.time = time
        self.times = times
        self.done = 0

    def initialise(self) -> None:
        self.done = 0

    def kept(self) -> Mapping[str, Any] | None:
        return {"done": self.done} if self.status is Status.RUNNING else None

    def restore(self, state: Mapping[str, Any]) -> None:
        self.done = state["done"]

    def update(self) -> Status:
        if self.decorated.status is not Status.SUCCESS:
            return self.decorated.status
        self.done += 1
        if self.done >= self.times:
            return Status.SUCCESS
        self.time.wake_at(self.time.now)
        return Status.RUNNING


class AtMost(Around):
    """Its step ends within `seconds`, or is left, and the task fails."""

    def __init__(self, child: Behaviour, context: Context, *, seconds: float) -> None:
        super().__init__(TIMEOUT, child)
        self.time, self.failures = context.time, context.failures
        self.seconds = seconds
        self.until = 0.0

    def initialise(self) -> None:
        self.until = self.time.now + self.seconds
        self.time.wake_at(self.until)

    def begin_anew(self) -> None:
        self.initialise()

    def update(self) -> Status:
        if self.decorated.status is not Status.RUNNING or self.time.now < self.until:
            return self.decorated.status
        self.decorated.stop(Status.INVALID)
        sentence = TOO_LATE(step=self.decorated.name, seconds=self.seconds)
        self.failures.add(Failure(reason=Reason.DEADLINE, sentence=sentence), self)
        return Status.FAILURE


class Forgiven(Around):
    """Its step may fail, for another one is tried then."""

    def __init__(self, child: Behaviour, failures: Failures) -> None:
        super().__init__(TRY, child)
        self.failures = failures

    def update(self) -> Status:
        if self.decorated.status is Status.FAILURE:
            self.failures.forgive()
        return self.decorated.status


class Inverted(Around):
    """Its step has to fail."""

    def __init__(self, child: Behaviour, failures: Failures) -> None:
        super().__init__(INVERT, child)
        self.failures = failures

    def update(self) -> Status:
        if self.decorated.status is Status.FAILURE:
            self.failures.forgive()
            return Status.SUCCESS
        if self.decorated.status is Status.SUCCESS:
            sentence = NOT_FAILED(step=self.decorated.name)
            self.failures.add(Failure(reason=Reason.REJECTED, sentence=sentence), self)
            return Status.FAILURE
        return self.decorated.status
