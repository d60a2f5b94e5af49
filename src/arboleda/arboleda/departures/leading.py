"""Leadership of a plant that several hosts reach: rules for a process, by its clock and by the common store.

Adapters, the runtime and the simulator decide by these rules alone. No rule compares the clocks of two
machines: a leader counts from when it asked for its lease, a waiting process from when it saw the leader's
row change last. A leader that cannot reach the store does not know whether another process leads. It lets
stops out until it ends, since nobody else may be there to stop the robots.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from enum import Enum

from arboleda.model.cell_states import CellState
from arboleda.model.commands import Command
from arboleda.model.messages import Notice

from .leaving import leaves_unkept

LEASE_S = 2.5  # by the clock of a waiting process; after so long a silence the leader may be superseded
# By its own clock a leader is sure for less. Clocks of two machines do not run equally fast: where the
# leader's is slower by up to a twenty-fifth, and that of the waiting process faster by as much, the lease
# still ends first.
SURE_S = 2.3
RENEW_S = 0.5  # period in which a leader renews its lease
AGAIN_S = 1.0  # for so long a call that finds no store is repeated, as while a database restarts
LOOK_S = 0.2  # period in which a waiting process looks whether there is a leader
WANTED_S = 30.0  # a request for another leader is given up after so long


class Standing(Enum):
    """Standing of a process that led, as far as it knows."""

    LEADS = "leads"
    UNSURE = "unsure"  # the process cannot find out, or can keep nothing: it stops all motion, and ends
    SUPERSEDED = "superseded"  # another process leads and commands the robots; this one sends nothing


class Lease:
    """Lease of a leader by its own clock: until it ends, no other process can lead."""

    def __init__(self) -> None:
        self._until = -math.inf

    def renewed(self, sent_at: float) -> None:
        """Note that the store renewed the lease. It counts from the request, as the answer may be late."""
        self._until = sent_at + SURE_S

    def lasts(self, now: float) -> bool:
        """True while no other process can lead."""
        return now < self._until


class Silence:
    """Silence of a leader, by the clock of a waiting process: somebody may set the clock of the store."""

    def __init__(self) -> None:
        self._last_state: object = None
        self._since = math.inf

    def ends_lease(self, now: float, state: object) -> bool:
        """True once the silence has lasted as long as a lease.

        `state` is the leader's row in the store, which changes with every message of the leader.
        """
        if state != self._last_state:
            self._last_state, self._since = state, now
        return now - self._since >= LEASE_S


def may_leave(message: Command | Notice, standing: Standing) -> bool:
    """True where a process may still let a message out to robots."""
    if standing is Standing.UNSURE:
        return leaves_unkept(message)
    return standing is Standing.LEADS


def at_work(states: Mapping[str, str]) -> list[str]:
    """The cells that a leader holds before a planned change of leaders, and that the next leader resumes."""
    return [name for name, state in states.items() if state == CellState.EXECUTE]


def all_stand(states: Mapping[str, str], held: Iterable[str]) -> bool:
    """True once all cells that were held for a planned change stand still."""
    return not any(states[name] == CellState.HOLDING for name in held)
