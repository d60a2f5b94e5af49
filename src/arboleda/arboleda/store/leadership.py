"""Leaders of plants as others see them, whatever database keeps the plants' memories."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True, kw_only=True)
class Leader:
    """The plant's last leader, and whether it still leads.

    `leads`: it has renewed its lease lately, by the clock of the database; nobody takes a plant over by this
    field. `url`: its page, "" if it gave none. `standbys`: the number of processes that wait to take over.
    """

    epoch: int
    host: str
    process: int
    url: str
    leads: bool
    standbys: int


class Leadership(Protocol):
    """Connection of a waiting process, for one thread at a time; ArboledaError without the database."""

    name: str

    def prepare(self) -> None:
        """Make what the plant needs there; raises StartError if that is impossible."""

    def leader(self) -> Leader: ...
    def is_free(self) -> bool:
        """True if nobody leads: the last leader gave the plant back, or was silent for the length of a lease.

        The silence is counted over repeated calls.
        """

    def wait_here(self, url: str = "") -> None:
        """Store that this process waits to lead, and the address of its page."""

    def own_address(self) -> str:
        """The address by which hosts that reach the database may reach this one; "" if unknown."""

    def wait_no_more(self) -> None: ...
    def ask_for_handover(self) -> None:
        """Ask the leader to hold all work, and to hand the plant over."""

    def close(self) -> None:
        """Close the connection; idempotent."""


class Leaders(Protocol):
    """Reader of all plants of a database, for one thread at a time; ArboledaError without the database."""

    def all(self) -> Mapping[str, Leader]:
        """The leaders by the name of the plant; only of plants that this user may read."""

    def close(self) -> None:
        """Close the connection; idempotent."""
