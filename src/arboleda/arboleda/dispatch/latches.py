"""Latches of robots: stops (software) that outlive restarts, and end by clear and reset alone."""

from __future__ import annotations

from arboleda.model.commands import StopMode
from arboleda.model.messages import Fact

from .belief import Belief
from .fact_memory import FactMemory, Memory
from .outlet import Outlet

LATCHED, CLEARED = "on", "cleared"  # a stop as it is kept: until clear, and until reset


class Latches:
    """Latches of robots: nothing moves those that are in `stopped`.

    `cleared` are robots that an earlier start had cleared and whose cells it had not reset. `unheard` are
    robots whose stop was cleared while they were offline.
    """

    def __init__(self, beliefs: dict[str, Belief], kept: Memory, memory: FactMemory, outlet: Outlet) -> None:
        stopped = kept.get(Fact.LATCH, {})
        self.stopped = {name for name in beliefs if stopped.get(name) == LATCHED}
        self.cleared = {name for name in beliefs if stopped.get(name) == CLEARED}
        self.unheard: set[str] = set()
        self._beliefs = beliefs
        self._memory = memory
        self._outlet = outlet

    def latch(self, robot: str) -> None:
        """Stop a robot and let nothing move it until `unlatch`, whatever restarts meanwhile."""
        self.stopped.add(robot)
        self.unheard.discard(robot)
        self._memory.remember(Fact.LATCH, robot, LATCHED)
        self._outlet.stop(robot, StopMode.LATCH)

    def unlatch(self, robot: str) -> None:
        """Clear a robot's stop; it moves nothing, and the cell still needs its reset."""
        self.stopped.discard(robot)
        self._beliefs[robot].barred = False
        if not self._beliefs[robot].online:
            self.unheard.add(robot)
        self._memory.remember(Fact.LATCH, robot, CLEARED)
        self._outlet.stop(robot, StopMode.CLEAR)

    def forget(self, robot: str) -> None:
        """A cleared robot's cell was reset: the stop is over."""
        self._memory.remember(Fact.LATCH, robot, None)
