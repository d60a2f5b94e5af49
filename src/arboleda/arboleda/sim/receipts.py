"""Numbering rules of a board for (epoca, seq): the choice of the commands that count, and their receipts."""

from __future__ import annotations

from collections import deque

from arboleda.model import refusals
from arboleda.model.facts import Value
from arboleda.wire import epochs
from arboleda.wire.payloads import MOST_FAILURES, Goal, StopGoal

UNKNOWN_SEQ = 0  # senders count from 1


class Receipts:
    """Numbers of the last accepted, finished and refused command, the last answer, and the last few failures.

    All count only for `epoch`. `least` is the oldest epoch that still counts: that of the newest heartbeat or
    command. The tokens are those that the accepted and the finished one carried. `words` has all of these.
    `known` is the number of accepted commands that are recognised if they come twice.
    """

    def __init__(self, *, known: int = 1) -> None:
        self._recent: deque[int | None] = deque(maxlen=known)
        self._enter(None)

    def _enter(self, epoch: int | None) -> None:
        """Forget all numbers, as those of one epoch mean nothing in the next."""
        self.epoch = self.least = epoch
        self.accepted: int | None = None
        self.finished: int | None = None
        self.accepted_token: str | None = None
        self.finished_token: str | None = None
        self.refusal: str | None = None
        self.refused: int | None = None
        self.answer: tuple[int, Value] | None = None
        self.failures: tuple[tuple[int, str], ...] = ()
        self._recent.clear()
        self._note()

    def _note(self) -> None:
        given_up = self.failures
        self.words = (
            self.epoch,
            self.least,
            self.accepted,
            self.finished,
            self.refusal,
            self.refused,
            self.answer,
            given_up,
            self.accepted_token,
            self.finished_token,
        )

    def hear(self, epoch: int) -> bool:
        """Take a heartbeat, after which older epochs no longer count; False if no plant can have this epoch.

        The numbers stay until a command comes: a plant that has just begun reads in them the end of the last
        one.
        """
        if self.least is not None and epoch <= self.least:
            return True
        if not epochs.can_follow(epoch, self.least):
            return False
        self.least = epoch
        self._note()
        return True

    def repeats(self, goal: Goal) -> bool:
        """True if this is an accepted command once more (QoS 1 may deliver twice)."""
        return goal.seq is not None and goal.epoch == self.epoch and goal.seq in self._recent

    def objection(self, goal: Goal) -> str | None:
        """The refusal of a command by its numbers, None for none; a newer epoch becomes the current one."""
        if goal.seq is None or goal.epoch is None:
            return refusals.FORMAT
        if self.least is not None and goal.epoch < self.least:
            return refusals.OLD
        if self.epoch is None or goal.epoch > self.epoch:
            self._enter(goal.epoch)
            return None
        last = -1 if self.accepted is None else self.accepted
        return refusals.OLD if (goal.epoch, goal.seq) <= (self.epoch, last) else None

    def accept(self, goal: Goal) -> None:
        self.accepted = goal.seq
        self.accepted_token = None if isinstance(goal, StopGoal) else goal.token
        self._recent.append(goal.seq)
        self._note()

    def finish(self, goal: Goal) -> None:
        """Note that a motion ended by itself; one of an older epoch no longer matters."""
        if goal.epoch == self.epoch:
            self.finished = goal.seq
            self.finished_token = None if isinstance(goal, StopGoal) else goal.token
            self._note()

    def answered(self, goal: Goal, answer: Value) -> None:
        """Note the answer to a query."""
        if goal.epoch == self.epoch and goal.seq is not None:
            self.answer = (goal.seq, answer)
            self._note()

    def fail(self, goal: Goal, word: str) -> None:
        """Note a command that gave up by itself."""
        if goal.epoch == self.epoch and goal.seq is not None:
            self.failures = (*self.failures, (goal.seq, word))[-MOST_FAILURES:]
            self._note()

    def refuse(self, word: str, seq: int | None, epoch: int | None) -> None:
        """Note a refusal; a number under a foreign epoch could be taken for one of the current sender."""
        # `viejo` is for the sender of the older epoch, which recognises its number
        ours = word == refusals.OLD or self.epoch in (None, epoch)
        self.refusal = word
        self.refused = seq if ours and seq is not None else UNKNOWN_SEQ
        self._note()
