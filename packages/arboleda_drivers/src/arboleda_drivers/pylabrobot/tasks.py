"""Calls of a machine that are under way, or that have ended and were not told yet."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from arboleda.drivers import Command, OnStop, Stop, VerbCommand, Work

from .messages import Raised, Returned


@dataclass(kw_only=True)
class Task:
    """Calls under way; `command` None: nobody waits for their end any more. `sets` are the facts that they
    are to change. `over`: they have ended so.
    """

    number: int
    began_at: float
    until: float
    command: VerbCommand | Stop | None
    is_work: bool = False
    sets: frozenset[str] = frozenset()
    over: Returned | Raised | None = None
    first_look: int = 0  # the first look that began after the end

    @property
    def finishes(self) -> bool:
        """True for a work that goes on to its own end when it is stopped."""
        works = self.is_work and self.over is None
        return works and isinstance(self.command, Work) and self.command.on_stop is OnStop.FINISH


class Tasks(dict[int, Task]):
    """Tasks of one machine, by number; `side_by_side`: its backend takes questions beside a work."""

    def __init__(self, *, side_by_side: bool) -> None:
        super().__init__()
        self._side_by_side = side_by_side

    @property
    def are_disturbed(self) -> bool:
        """True where a question might disturb what is under way."""
        return not self._side_by_side and any(task.over is None for task in self.values())

    @property
    def stops(self) -> bool:
        return any(isinstance(task.command, Stop) for task in self.values())

    @property
    def works(self) -> bool:
        return any(task.is_work for task in self.values())

    def takes(self, command: Command) -> bool:
        """True where a call may begin now: one at a time, or one work beside questions."""
        if self._side_by_side:
            return not isinstance(command, Work) or not (self.works or self.stops)
        return not self

    def late(self, now: float) -> Task | None:
        """A task that should have ended by now."""
        return next((task for task in self.values() if task.over is None and task.until <= now), None)

    def disown(self) -> None:
        """Nobody waits for any end any more."""
        for task in self.values():
            task.command = None


class UnknownFacts:
    """Facts of which only PyLabRobot's count is read, `counted`, and that a call may have changed or not."""

    def __init__(self, counted: Iterable[str]) -> None:
        self._counted = frozenset(counted)
        self.names: frozenset[str] = frozenset()

    def end(self, task: Task, *, began: bool = True) -> None:
        """Note the end of a call: one that returned has set its facts; `began`: it may have changed some."""
        if isinstance(task.over, Returned):
            self.names -= task.sets
        elif began:
            self.names |= task.sets & self._counted
