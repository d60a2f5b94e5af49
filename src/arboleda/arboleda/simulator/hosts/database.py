"""The store of a plant that two hosts reach: the row that says who leads, and what is kept behind it.

The row does as the statements of `store/postgres` do on a server; `tests/contract/test_leader_row.py`
holds the one against the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from arboleda.core.leading import LEASE_S, WANTED_S
from arboleda.model.messages import Notice

from ..disk import Disk, DiskFull
from .process import Process


@dataclass(slots=True)
class LeaderRow:
    """Who leads under which number, and when he said so last; all times are of the store's clock, s."""

    epoch: int
    seen: float | None = None
    wanted: float | None = None  # when somebody asked for another leader
    going: tuple[str, ...] = ()  # the cells that the last leader held for the change alone

    @property
    def last_seen(self) -> tuple[int, float | None]:
        """What is another thing whenever a leader says anything."""
        return self.epoch, self.seen

    def leads(self, now: float) -> bool:
        """Whether somebody has said lately that he leads, as whoever only looks sees it."""
        return self.seen is not None and abs(now - self.seen) < LEASE_S

    def end_lease(self, last_seen: tuple[int, float | None]) -> None:
        """That leader leads no more, where he has said nothing since."""
        if last_seen == self.last_seen:
            self.seen = None

    def lead(self, proposed: int, now: float) -> tuple[int, tuple[str, ...]] | None:
        """Lead under that number or a higher one, and what is to go on; None where somebody leads."""
        if self.seen is not None:
            return None
        going = self.going if self._is_wanted(now) else ()
        self.epoch, self.seen = max(self.epoch + 1, proposed), now
        self.wanted, self.going = None, ()
        return self.epoch, going

    def renew(self, epoch: int, now: float) -> bool | None:
        """Go on leading: whether another leader is wanted; None where that number leads no more."""
        if epoch != self.epoch or self.seen is None:
            return None
        self.seen = now
        return self._is_wanted(now)

    def hand_over(self, epoch: int, going: Sequence[str]) -> None:
        """Say what the next leader goes on with."""
        if epoch == self.epoch:
            self.going = tuple(going)

    def give_back(self, epoch: int) -> None:
        """Lead no more, so that who waits begins at once."""
        if epoch == self.epoch:
            self.seen = None

    def is_fenced(self, epoch: int) -> bool:
        """Whether who leads under that number may write."""
        return epoch == self.epoch

    def _is_wanted(self, now: float) -> bool:
        return self.wanted is not None and abs(now - self.wanted) < WANTED_S


class StoreUnreachable(DiskFull):
    """The store cannot be reached, so nothing can be kept."""


class StoreRefused(DiskFull):
    """Another process leads: the store takes nothing more from this one."""


@dataclass(frozen=True, kw_only=True)
class Write:
    """Something that the store took from a process that leads under `epoch`, while `leads` did."""

    epoch: int
    leads: int
    message: Notice


class SharedDisk(Disk):
    """What the store keeps; `writer` is the process whose plant writes with `commit`.

    `forgets`: of how many statements the answer is lost next, so that they are sent once more. `writes` is
    all that it took since somebody looked.
    """

    def __init__(self, row: LeaderRow) -> None:
        super().__init__()
        self.row = row
        self.writer: Process | None = None
        self.forgets = 0
        self.writes: list[Write] = []

    def commit(self, message: Notice, now: float) -> float:
        if self.writer is None:
            return super().commit(message, now)
        return self.take(self.writer, message, now)

    def take(self, writer: Process, message: Notice, now: float) -> float:
        """One statement of a process: how long it takes, s; Refused, or Away where it hears no answer."""
        took = 0.0
        if writer.host.reaches:
            took += self._fenced(writer.epoch, message, now)
        if not writer.host.hears:
            raise StoreUnreachable("the store cannot be reached")
        if self.forgets:
            self.forgets -= 1
            took += self._fenced(writer.epoch, message, now)
        return took + writer.host.delay_s

    def _fenced(self, epoch: int, message: Notice, now: float) -> float:
        if not self.row.is_fenced(epoch):
            raise StoreRefused("another process leads the plant now: this one steps down")
        self.writes.append(Write(epoch=epoch, leads=self.row.epoch, message=message))
        return super().commit(message, now)
