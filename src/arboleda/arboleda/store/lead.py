"""The lead of a plant, as the process has it that keeps the plant's memory."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from arboleda.model.errors import ArboledaError, StartError


class Superseded(ArboledaError):
    """Error: another process leads this plant now; this one must neither write nor send anything more."""


class OtherLeader(StartError):
    """Error: another process leads this plant, and is alive."""


@dataclass(frozen=True, kw_only=True)
class Standby:
    """Process that waits to lead the plant: its host, and its page, "" if it gave none."""

    host: str
    url: str


class Lead:
    """The lead of a plant whose memory is a file: only one process of one host reaches it.

    Methods but `take` and `renew` are callable from any thread. They raise ArboledaError.
    """

    standbys: Sequence[Standby] = ()  # processes that wait to lead, as of the last renewal
    going: Sequence[str] = ()  # cells that the last leader held only for the change
    renew_s: float | None = None  # period of calls of `renew` while the plant is led; None: never

    @property
    def is_certain(self) -> bool:
        """True while this process is known to lead, without asking the server."""
        return True

    def take(self, epoch: int) -> int:
        """Take the lead under `epoch`, or a higher number if the memory knows higher ones; returns the
        number.

        Raises StartError if another process leads.
        """
        return epoch

    def renew(self) -> bool:
        """Renew the lead; True if another process is wanted as the leader.

        Called in one thread of its own. Raises Superseded, or ArboledaError if the memory cannot be reached.
        """
        return False

    def own_address(self) -> str:
        """The address by which hosts that reach the memory may reach this one, "" if unknown."""
        return ""

    def announce(self, url: str) -> None:
        """Store the address of the plant's page."""

    def hand_over(self, going: Sequence[str]) -> None:
        """Store for the next leader the cells that are held for the change only."""
