"""The (epoca, seq) rules of a board: which command counts, and what its telemetry says about it."""

from __future__ import annotations

from arboleda.wire.payloads import Goal

UNKNOWN_SEQ = 0  # senders count from 1


class Receipts:
    """The numbers of the last accepted, finished and refused command; all count only for `epoch`.

    `told` is all of it.
    """

    def __init__(self) -> None:
        self._enter(None)

    def _enter(self, epoch: int | None) -> None:
        """Forget all numbers: those of one epoch mean nothing in the next."""
        self.epoch = epoch
        self.accepted: int | None = None
        self.finished: int | None = None
        self.refusal: str | None = None
        self.refused: int | None = None
        self._note()

    def _note(self) -> None:
        self.told = (self.epoch, self.accepted, self.finished, self.refusal, self.refused)

    def repeats(self, goal: Goal) -> bool:
        """Whether this is the last accepted command once more (QoS 1 may deliver twice)."""
        return goal.seq is not None and (goal.epoch, goal.seq) == (self.epoch, self.accepted)

    def objection(self, goal: Goal) -> str | None:
        """The refusal its numbers deserve; a fresh command makes its epoch the current one."""
        if goal.seq is None or goal.epoch is None:
            return "formato"
        if self.epoch is None or goal.epoch > self.epoch:
            self._enter(goal.epoch)
            return None
        last = -1 if self.accepted is None else self.accepted
        return "viejo" if (goal.epoch, goal.seq) <= (self.epoch, last) else None

    def accept(self, goal: Goal) -> None:
        self.accepted = goal.seq
        self._note()

    def finish(self, goal: Goal) -> None:
        """A motion ended by itself; one of an older epoch is nobody's news any more."""
        if goal.epoch == self.epoch:
            self.finished = goal.seq
            self._note()

    def refuse(self, word: str, seq: int | None, epoch: int | None) -> None:
        """Note a refusal; under a foreign epoch its number could be taken for one of the current sender."""
        # `viejo` is for the sender of the older epoch, which knows itself by its number
        ours = word == "viejo" or self.epoch in (None, epoch)
        self.refusal = word
        self.refused = seq if ours and seq is not None else UNKNOWN_SEQ
        self._note()
