"""Store of a plant that two hosts reach: the row that names the leader, and what is kept behind it.

The row behaves as the statements of `arboleda_fleet` do on a server; its `real/postgres/test_leader_row.py`
compares the two.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from arboleda.departures.leading import LEASE_S, WANTED_S
from arboleda.model.messages import Notice

from ..disk import Disk, DiskFull
from .process import Process


@dataclass(slots=True)
class LeaderRow:
    """The leader's number, and the time of its last renewal; all times are of the store's clock, s."""

    epoch: int
    renewed_at: float | None = None
    wanted: float | None = None  # when somebody asked for another leader
    going: tuple[str, ...] = ()  # the cells that the last leader held for the change alone

    @property
    def lease_state(self) -> tuple[int, float | None]:
        """A value that changes with every statement of a leader."""
        return self.epoch, self.renewed_at

    def leads(self, now: float) -> bool:
        """True if a leader has renewed its lease lately, as a process sees it that only looks."""
        return self.renewed_at is not None and abs(now - self.renewed_at) < LEASE_S

    def end_lease(self, lease_state: tuple[int, float | None]) -> None:
        """End the lease of a leader if it has not renewed it since then."""
        if lease_state == self.lease_state:
            self.renewed_at = None

    def lead(self, proposed: int, now: float) -> tuple[int, tuple[str, ...]] | None:
        """Lead under this number or a higher one; return it and what is to go on; None if another leads."""
        if self.renewed_at is not None:
            return None
        going = self.going if self._is_wanted(now) else ()
        self.epoch, self.renewed_at = max(self.epoch + 1, proposed), now
        self.wanted, self.going = None, ()
        return self.epoch, going

    def renew(self, epoch: int, now: float) -> bool | None:
        """Renew the lease; return whether another leader is wanted, or None if this number leads no more."""
        if epoch != self.epoch or self.renewed_at is None:
            return None
        self.renewed_at = now
        return self._is_wanted(now)

    def hand_over(self, epoch: int, going: Sequence[str]) -> None:
        """Record what the next leader is to go on with."""
        if epoch == self.epoch:
            self.going = tuple(going)

    def give_back(self, epoch: int) -> None:
        """Give up the lease, so that a waiting process can lead at once."""
        if epoch == self.epoch:
            self.renewed_at = None

    def is_fenced(self, epoch: int) -> bool:
        """True if the leader with this number may write."""
        return epoch == self.epoch

    def _is_wanted(self, now: float) -> bool:
        return self.wanted is not None and abs(now - self.wanted) < WANTED_S


class StoreUnreachable(DiskFull):
    """Raised when the store cannot be reached, so that nothing can be kept."""


class StoreRefused(DiskFull):
    """Raised when another process leads: the store takes nothing more from this one."""


@dataclass(frozen=True, kw_only=True)
class Write:
    """Something that the store took from a process that leads under `epoch`, while `leads` did."""

    epoch: int
    leads: int
    message: Notice


class SharedDisk(Disk):
    """Disk that the store keeps; `writer` is the process whose plant writes with `commit`.

    `forgets`: the number of next statements whose answer is lost, so that they are sent once more. `writes`
    is all that it took since it was last emptied.
    """

    def __init__(self, row: LeaderRow) -> None:
        super().__init__()
        self.row = row
        self.writer: Process | None = None
        self.forgets = 0
        self.writes: list[Write] = []

    def commit(self, message: Notice, now: float, *, precedes_commands: bool = True) -> float:
        if self.writer is None:
            return super().commit(message, now, precedes_commands=precedes_commands)
        return self.take(self.writer, message, now)

    def take(self, writer: Process, message: Notice, now: float) -> float:
        """Take one statement of a process; return its seconds. Raises StoreRefused or StoreUnreachable."""
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
        took = super().commit(message, now)
        self.sync()  # the server is asked for that with the statement
        return took
