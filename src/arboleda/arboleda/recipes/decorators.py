"""Steps around steps: retry, repeat, time limit, fallback, rescue, inversion.

The plant's events and times wake them. Decorators of py_trees would ask a clock of their own.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.decorators import Decorator

from arboleda.engine import (
    LEAST_S,
    CellTime,
    Context,
    Failures,
    Keeps,
    title_of,
    titled,
)
from arboleda.model.kept_failures import failure_kept, read_failure
from arboleda.model.messages import Failure, Reason
from arboleda.model.sentence import Phrase, Sentence

RETRY = Phrase("step.retry", "retry {step}")
REPEAT = Phrase("step.repeat", "repeat {step}")
TIMEOUT = Phrase("step.timeout", "timeout {step}")
TRY = Phrase("step.forgive", "try {step}")
RESCUE = Phrase("step.rescue", "rescue: {step}")
INVERT = Phrase("step.invert", "invert {step}")
TOO_LATE = Phrase("recipe.too_late", "{step} did not end within {seconds:g} s")
RESCUE_FAILED = Phrase("recipe.rescue_failed", "{cause}; and the rescue failed: {second}")
NO_RESCUE = frozenset({Reason.STOPPED, Reason.CANCELLED, Reason.INTERRUPTED, Reason.INTERNAL})
"""Reasons of a failure after which nothing of the task may go on."""
NOT_FAILED = Phrase("recipe.not_failed", "{step} was to fail, and did not")


class Around(Keeps, Decorator):
    """A step around a step; screens name the inner one."""

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
        self.again_at = self.time.now + max(self.pause_s, LEAST_S)
        self.time.wake_at(self.again_at)
        return Status.RUNNING


class Times(Around):
    """Does its step `times` times, one after the other."""

    def __init__(self, child: Behaviour, time: CellTime, *, times: int) -> None:
        super().__init__(REPEAT, child)
        self.time = time
        self.times = times
        self.done = 0
        self.begun_at = self.next_at = -math.inf

    def initialise(self) -> None:
        self.done = 0
        self.begun_at, self.next_at = self.time.now, -math.inf

    def kept(self) -> Mapping[str, Any] | None:
        return {"done": self.done} if self.status is Status.RUNNING else None

    def restore(self, state: Mapping[str, Any]) -> None:
        self.done = state["done"]

    def tick(self) -> Iterator[Behaviour]:
        if self.status is Status.RUNNING and self.time.now < self.next_at:
            yield self
            return
        yield from super().tick()

    def update(self) -> Status:
        if self.decorated.status is not Status.SUCCESS:
            return self.decorated.status
        self.done += 1
        if self.done >= self.times:
            return Status.SUCCESS
        now = self.time.now
        self.next_at = now if self.begun_at < now else now + LEAST_S
        self.begun_at = self.next_at
        self.time.wake_at(self.next_at)
        return Status.RUNNING


class AtMost(Around):
    """Its step ends within `seconds`, or is halted and fails."""

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
    """Its step may fail, for another step is tried after it."""

    def __init__(self, child: Behaviour, failures: Failures) -> None:
        super().__init__(TRY, child)
        self.failures = failures

    def update(self) -> Status:
        if self.decorated.status is Status.FAILURE:
            self.failures.forgive()
        return self.decorated.status


class Rescue(Around):
    """Does its step because another step has failed; the cause of that failure stays the cause.

    Meanwhile the cause is put aside, so that the step sees only failures of its own.
    """

    def __init__(self, child: Behaviour, failures: Failures) -> None:
        super().__init__(RESCUE, child)
        self.failures = failures
        self.cause: Failure | None = None
        self.leaf: Behaviour | None = None

    def initialise(self) -> None:
        self.cause, self.leaf = self.failures.first, self.failures.leaf
        self.failures.forgive()

    def kept(self) -> Mapping[str, Any] | None:
        if self.status is not Status.RUNNING or self.cause is None:
            return None
        return {"cause": failure_kept(self.cause)}

    def restore(self, state: Mapping[str, Any]) -> None:
        self.cause = read_failure(*state["cause"])

    def tick(self) -> Iterator[Behaviour]:
        first = self.failures.first
        if self.status is not Status.RUNNING and first is not None and first.reason in NO_RESCUE:
            self.status = Status.FAILURE
            yield self
            return
        yield from super().tick()

    def update(self) -> Status:
        if self.decorated.status is Status.RUNNING:
            return Status.RUNNING
        if self.cause is not None:
            self.failures.bring_back(with_second(self.cause, self.failures.first), self.leaf)
        return Status.FAILURE

    def terminate(self, new_status: Status) -> None:
        if new_status is Status.INVALID and self.status is Status.RUNNING and self.cause is not None:
            self.failures.bring_back(self.cause, self.leaf)


def with_second(cause: Failure, second: Failure | None) -> Failure:
    """The first cause, with the cause of a failed rescue."""
    if second is None:
        return cause
    sentence = RESCUE_FAILED(cause=cause.sentence, second=second.sentence)
    return Failure(reason=cause.reason, sentence=sentence)


def first_cause(sentence: Sentence) -> Sentence:
    """The sentence of the first cause, without that of a failed rescue."""
    cause = sentence.values.get("cause") if sentence.key == RESCUE_FAILED.key else None
    return first_cause(cause) if isinstance(cause, Sentence) else sentence


class Inverted(Around):
    """Succeeds if its step fails, and fails if its step succeeds."""

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
