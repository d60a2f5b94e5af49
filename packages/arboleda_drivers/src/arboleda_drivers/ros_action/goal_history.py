"""History of a server's goals: the last command that it took, as numbers that outlive the plant."""

from __future__ import annotations

from collections.abc import Sequence
from zlib import crc32

from arboleda.drivers import Command, Receipt, Tokens

from .events import ListedGoal, Status
from .goal import Goal
from .goal_id import NUMBER_BITS, GoalId, hash_of

FOREIGN_EPOCH = 0  # of no start of a plant


class GoalHistory:
    """History of the goals of one device's server; `receipt` and `tokens` are for the reports of the device.

    What this start of the driver sent it knows from the server's answers. What an earlier one sent, and what
    others sent, is in the server's list of goals.
    """

    def __init__(self, device: str) -> None:
        self._device = hash_of(device)
        self._count = 0
        self._command: GoalId | None = None  # the one that was begun last
        self._sent: dict[str, GoalId] = {}  # goals without an answer
        self._accepted: GoalId | None = None  # of the last command that the server took
        self._done: GoalId | None = None
        self._is_ours = False  # True once the server took a goal of this start
        self._foreign: bytes | None = None  # the id of the last goal while that is somebody else's
        self.has_earlier_goal = False  # a goal has no end that this start neither sent nor cancelled
        self._looks_back = True

    @property
    def receipt(self) -> Receipt | None:
        """The numbers of the last commands taken and done; None where the server has listed no goal."""
        if self._foreign is not None:  # another number for each, so that two of them do not look like none
            return Receipt(FOREIGN_EPOCH, crc32(self._foreign))
        last = self._accepted
        if last is None:
            return None
        done = self._done
        return Receipt(last.epoch, last.number, done.number if done and done.epoch == last.epoch else None)

    @property
    def tokens(self) -> Tokens | None:
        """The tokens of the same commands."""
        if self._foreign is not None or self._accepted is None or self.receipt is None:
            return None
        done = self._done.token if self._done and self.receipt.done is not None else None
        return Tokens(self._accepted.token, done)

    def begin(self, command: Command) -> None:
        """Number a command, whose first goal is sent next."""
        start = command.id.partition("-")[0]
        self._count = self._count % ((1 << NUMBER_BITS) - 1) + 1
        self._command = GoalId(
            device=self._device,
            epoch=int(start) if start.isdecimal() else 0,
            number=self._count,
            is_last=False,
            token=command.token,
        )

    def send(self, goal: Goal) -> bytes:
        """The id for the next goal of the command that was begun last."""
        assert self._command is not None
        sent = self._sent[goal.key] = self._command._replace(is_last=goal.is_at_last_part)
        return sent.uuid

    def answer(self, key: str, *, accepted: bool) -> None:
        """The server has taken or refused a goal."""
        sent = self._sent.pop(key, None)
        if accepted and sent is not None:
            self._accepted, self._is_ours, self._foreign = sent, True, None
            self.leave_behind()

    def end(self) -> None:
        """The command whose goal was taken last has ended well."""
        self._done = self._accepted

    def forget(self) -> None:
        """The server was started anew."""
        self._accepted = self._done = None
        self._sent.clear()
        self._foreign, self._is_ours = None, False
        self.leave_behind()

    def leave_behind(self) -> None:
        """Take earlier goals of the server for cancelled or replaced: it may list them for a while."""
        self._looks_back = self.has_earlier_goal = False

    def list(self, goals: Sequence[ListedGoal]) -> None:
        """Take the server's list of goals, in any order."""
        self.has_earlier_goal = self._looks_back and any(each.status is None for each in goals)
        if not goals:
            return
        newest = max(goals, key=lambda each: each.stamp)
        last = GoalId.read(newest.uuid)
        if last is None or last.device != self._device:
            # A list from before our last goal has no later goals.
            is_later = not self._is_ours or any(self._is_last(each) for each in goals)
            self._foreign = newest.uuid if is_later else None
        elif self._is_ours:
            self._foreign = None if self._is_last(newest) else self._foreign
        else:
            self._accepted, self._foreign = last, None
            self._done = last if last.is_last and newest.status is Status.SUCCEEDED else None

    def _is_last(self, goal: ListedGoal) -> bool:
        return self._accepted is not None and goal.uuid == self._accepted.uuid
