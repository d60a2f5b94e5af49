"""Who leads a plant that several hosts reach, as far as a process can know: rules for its own clock and what
the common store tells it. Adapters, the app and the simulator decide by these and by no others.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from enum import Enum

from arboleda.model.commands import Command
from arboleda.model.messages import Notice

from .cell_states import CellState
from .leaving import leaves_unkept

LEASE_S = 2.5  # by the store's clock: who did not say for so long that he leads may be superseded
# By his own clock a leader is sure for less. Clocks of two machines do not run equally fast, and one that is
# slower by up to a twenty-fifth still finds its lease over before anybody else may lead.
SURE_S = 2.4
RENEW_S = 0.5  # how often a leader says that he leads
AGAIN_S = 1.0  # for how long what finds no store is tried again, as while a database restarts
LOOK_S = 0.2  # how often who waits looks whether anybody leads
WANTED_S = 30.0  # who asked for another leader waits no longer


class Standing(Enum):
    """What a process that led knows of itself."""

    LEADS = "leads"
    UNSURE = "unsure"  # it cannot find out, or can keep nothing: it stops what moves, and ends
    SUPERSEDED = "superseded"  # another one leads: the robots are his, and it tells them nothing


class Lease:
    """Until when a leader needs to ask nobody, by its own clock."""

    def __init__(self) -> None:
        self._until = -math.inf

    def renewed(self, asked_at: float) -> None:
        """The store took it; the time counts from before it was asked, since the answer may come late."""
        self._until = asked_at + SURE_S

    def lasts(self, now: float) -> bool:
        """Whether nobody else can lead yet."""
        return now < self._until


class Candidate:
    """Tries to lead a plant that may be led: who was killed and cannot say so is waited for, and no longer.

    `seen` is what the store last heard of a leader.
    """

    def __init__(self, now: float, seen: object) -> None:
        self._until = now + LEASE_S + RENEW_S
        self._seen = seen

    def gives_up(self, now: float, seen: object) -> bool:
        """Whether somebody else leads, and is alive."""
        return now > self._until or seen != self._seen


def may_leave(message: Command | Notice, standing: Standing) -> bool:
    """Whether a process may still let a message out to robots."""
    if standing is Standing.UNSURE:
        return leaves_unkept(message)
    return standing is Standing.LEADS


def at_work(states: Mapping[str, str]) -> list[str]:
    """The cells that a leader holds before a planned change, and that the next one resumes."""
    return [name for name, state in states.items() if state == CellState.EXECUTE]


def all_stand(states: Mapping[str, str], held: Iterable[str]) -> bool:
    """Whether all that was held for a planned change stands still."""
    return not any(states[name] == CellState.HOLDING for name in held)
