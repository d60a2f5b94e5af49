"""The (epoca, seq) rules of a board: which command counts, and what its telemetry says about it."""

from __future__ import annotations

from collections import deque

from arboleda.model.facts import Value
from arboleda.wire import epochs
from arboleda.wire.payloads import FAILURES_KEPT, Goal

UNKNOWN_SEQ = 0  # senders count from 1


class Receipts:
    """The numbers of the last accepted, finished and refused command, of the last answer and of the last few
    failures; all count only for `epoch`.

    `least` is the oldest epoch that still counts: that of the newest beat or command. `told` is all of it.
    `known` is how many accepted commands it knows again, should one come twice.
    """

    def __init__(self, *, known: int = 1) -> None:
        self._recent: deque[int | None] = deque(maxlen=known)
        self._enter(None)

    def _enter(self, epoch: int | None) -> None:
        """Forget all numbers: those of one epoch mean nothing in the next."""
        self.epoch = self.least = epoch
        self.accepted: int | None = None
        self.finished: int | None = None
        self.refusal: str | None = None
        self.refused: int | None = None
        self.answer: tuple[int, Value] | None = None
        self.failures: tuple[tuple[int, str], ...] = ()
        self._recent.clear()
        self._note()

    def _note(self) -> None:
        given_up = self.failures
        self.told = (
            self.epoch,
            self.least,
            self.accepted,
            self.finished,
            self.refusal,
            self.refused,
            self.answer,
            given_up,
        )

    def hear(self, epoch: int) -> bool:
        """A beat: what is older counts for nothing from now on; False where no plant can have that epoch.

        The numbers stay until a command comes: a plant that has just begun reads in them what became of the
        last one.
        """
        if self.least is not None and epoch <= self.least:
            return True
        if not epochs.can_follow(epoch, self.least):
            return False
        self.least = epoch
        self._note()
        return True

    def repeats(self, goal: Goal) -> bool:
        """Whether this is an accepted command once more (QoS 1 may deliver twice)."""
        return goal.seq is not None and goal.epoch == self.epoch and goal.seq in self._recent

    def objection(self, goal: Goal) -> str | None:
        """The refusal its numbers deserve; a fresh command makes its epoch the current one."""
        if goal.seq is None or goal.epoch is None:
            return "formato"
        if self.least is not None and goal.epoch < self.least:
            return "viejo"
        if self.epoch is None or goal.epoch > self.epoch:
            self._enter(goal.epoch)
            return None
        last = -1 if self.accepted is None else self.accepted
        return "viejo" if (goal.epoch, goal.seq) <= (self.epoch, last) else None

    def accept(self, goal: Goal) -> None:
        self.accepted = goal.seq
        self._recent.append(goal.seq)
        self._note()

    def finish(self, goal: Goal) -> None:
        """A motion ended by itself; one of an older epoch is nobody's news any more."""
        if goal.epoch == self.epoch:
            self.finished = goal.seq
            self._note()

    def answered(self, goal: Goal, answer: Value) -> None:
        """A query has its answer."""
        if goal.epoch == self.epoch and goal.seq is not None:
            self.answer = (goal.seq, answer)
            self._note()

    def fail(self, goal: Goal, word: str) -> None:
        """A command ended short, by itself."""
        if goal.epoch == self.epoch and goal.seq is not None:
            self.failures = (*self.failures, (goal.seq, word))[-FAILURES_KEPT:]
            self._note()

    def refuse(self, word: str, seq: int | None, epoch: int | None) -> None:
        """Note a refusal; under a foreign epoch its number could be taken for one of the current sender."""
        # `viejo` is for the sender of the older epoch, which knows itself by its number
        ours = word == "viejo" or self.epoch in (None, epoch)
        self.refusal = word
        self.refused = seq if ours and seq is not None else UNKNOWN_SEQ
        self._note()
