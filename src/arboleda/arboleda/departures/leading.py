"""Leadership of a plant that several hosts reach: rules for a process by its own clock and by what the common
store tells it. Adapters, the app and the simulator decide by these and by no others.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from enum import Enum

from arboleda.model.cell_states import CellState
from arboleda.model.commands import Command
from arboleda.model.messages import Notice

from .leaving import leaves_unkept

LEASE_S = 2.5  # by the clock of who waits: who did not say for so long that he leads may be superseded
# By his own clock a leader is sure for less. Clocks of two machines do not run equally fast: where his is
# slower by up to a twenty-fifth, and that of who waits faster by as much, his lease is still over first.
SURE_S = 2.3
RENEW_S = 0.5  # how often a leader says that he leads
AGAIN_S = 1.0  # for how long what finds no store is tried again, as while a database restarts
LOOK_S = 0.2  # how often who waits looks whether anybody leads
WANTED_S = 30.0  # who asked for another leader waits no longer


class Standing(Enum):
    """Standing of a process that led, as far as it knows."""

    LEADS = "leads"
    UNSURE = "unsure"  # it cannot find out, or can keep nothing: it stops what moves, and ends
    SUPERSEDED = "superseded"  # another one leads: the robots are his, and it tells them nothing


class Lease:
    """Until when a leader needs to ask nobody, by its own clock."""

    def __init__(self) -> None:
        self._until = -math.inf

    def renewed(self, sent_at: float) -> None:
        """The store took it; the time counts from before it was asked, since the answer may come late."""
        self._until = sent_at + SURE_S

    def lasts(self, now: float) -> bool:
        """True while nobody else can lead."""
        return now < self._until


class Silence:
    """For how long a leader has said nothing, by the clock of who waits for that: the store's may be set."""

    def __init__(self) -> None:
        self._last_state: object = None
        self._since = math.inf

    def ends_lease(self, now: float, state: object) -> bool:
        """True once it has lasted as long as a lease; `state` is what the store last heard of him, another
        thing whenever he says anything.
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
    """The cells that a leader holds before a planned change, and that the next one resumes."""
    return [name for name, state in states.items() if state == CellState.EXECUTE]


def all_stand(states: Mapping[str, str], held: Iterable[str]) -> bool:
    """True once all that was held for a planned change stands still."""
    return not any(states[name] == CellState.HOLDING for name in held)
