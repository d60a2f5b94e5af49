"""Latches of robots: stops (software) that outlive restarts, and end by clear and reset alone."""

from __future__ import annotations

from arboleda.model.commands import StopMode
from arboleda.model.messages import Fact, MotionState

from .belief import Belief
from .fact_memory import CLEARED, LATCHED, FactMemory, Memory
from .outlet import Outlet


class Latches:
    """Latches of robots: the plant sends no motion to a robot in `stopped`.

    A latch is a fact of the memory and not of a board: so a stop lasts over restarts of plant, bridge and
    board, and a robot that comes back is latched again. `cleared` are robots that an earlier start had
    cleared and whose cells it had not reset. `unheard` are robots whose stop was cleared while they were
    offline.
    """

    def __init__(self, beliefs: dict[str, Belief], facts: Memory, memory: FactMemory, outlet: Outlet) -> None:
        stopped = facts.get(Fact.LATCH, {})
        self.stopped = {name for name in beliefs if stopped.get(name) == LATCHED}
        self.cleared = {name for name in beliefs if stopped.get(name) == CLEARED}
        self.unheard: set[str] = set()
        self._beliefs = beliefs
        self._memory = memory
        self._outlet = outlet

    def latch(self, robot: str) -> None:
        """Stop a robot, and send it no motion until `unlatch`."""
        self.stopped.add(robot)
        self.unheard.discard(robot)
        self._memory.remember(Fact.LATCH, robot, LATCHED)
        self._outlet.stop(robot, StopMode.LATCH)

    def unlatch(self, robot: str) -> None:
        """Clear a robot's stop. That moves nothing, and the cell still needs its reset."""
        self.stopped.discard(robot)
        belief = self._beliefs[robot]
        belief.barred = False
        if belief.state is MotionState.STOP_LATCHED or not belief.robot.homes:
            belief.end_hearsay()
        if not self._beliefs[robot].online:
            self.unheard.add(robot)
        self._memory.remember(Fact.LATCH, robot, CLEARED)
        self._outlet.stop(robot, StopMode.CLEAR)

    def forget(self, robot: str) -> None:
        """End the stop of a cleared robot whose cell was reset."""
        self._memory.remember(Fact.LATCH, robot, None)
