"""Hosts, each with its clock and its connection to the store, and processes that led a plant there."""

from __future__ import annotations

from collections import Counter
from enum import Enum
from typing import TYPE_CHECKING

from arboleda.departures.leading import Lease, Silence, Standing

if TYPE_CHECKING:
    from .database import LeaderRow

ANSWER_S = 1.0  # a server that says nothing for so long counts as away


class StorePath(Enum):
    """The direction in which a host's connection to the store is cut."""

    TO = "to the store"
    BOTH = "both ways"
    FROM = "from the store"


class Host:
    """One of the two hosts; `delay_s`: the time the store takes to answer it, `wall_s`: how far its calendar
    is ahead, which counts for nothing but the number that it proposes.
    """

    def __init__(self, name: str, now: float) -> None:
        self.name = name
        self.cuts: Counter[StorePath] = Counter()
        self.delay_s = 0.0
        self.wall_s = 0.0
        self.silence = Silence()
        self._rate, self._since, self._shown = 1.0, now, now

    def clock(self, now: float) -> float:
        """The time on the host's own clock."""
        return self._shown + self._rate * (now - self._since)

    def run(self, now: float, rate: float) -> None:
        """Run its clock faster or slower than other clocks from now on."""
        self._shown, self._since, self._rate = self.clock(now), now, rate

    @property
    def rate(self) -> float:
        return self._rate

    @property
    def reaches(self) -> bool:
        """True if its statements reach the store."""
        return not (self.cuts[StorePath.TO] or self.cuts[StorePath.BOTH])

    @property
    def hears(self) -> bool:
        """True if answers of the store come back in time."""
        return self.reaches and not self.cuts[StorePath.FROM] and self.delay_s < ANSWER_S


class Process:
    """A process on `host` that led the plant under `epoch`; `standing` is what it knows of that."""

    def __init__(self, host: Host, epoch: int) -> None:
        self.host = host
        self.epoch = epoch
        self.lease = Lease()
        self.standing = Standing.LEADS

    def confirm(self, row: LeaderRow, now: float) -> Standing:
        """Confirm the lead before a message; ask the store only if the lease may be over."""
        if self.standing is not Standing.LEADS or self.lease.lasts(self.host.clock(now)):
            return self.standing
        took = row.renew(self.epoch, now) if self.host.reaches else None
        if not self.host.hears:
            self.standing = Standing.UNSURE
        elif took is None:
            self.standing = Standing.SUPERSEDED
        else:
            self.lease.renewed(self.host.clock(now))
        return self.standing
