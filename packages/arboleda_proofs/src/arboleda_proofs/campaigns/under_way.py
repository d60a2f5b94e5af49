"""Simulation under way: what passes in it is told, and it is cut where nothing more is looked for."""

from __future__ import annotations

from arboleda_proofs.simulator.run import MINUTE_S, Simulation

from .campaign import Passed

LOOK_S = 1.0  # of plant time, between two looks


class TimePassed(BaseException):
    """The time of a run has passed; an Exception would be blamed on the plant."""


class UnderWay:
    """UnderWay: calls `passed` with what passed since its last call, every LOOK_S of plant time."""

    def __init__(self, simulation: Simulation, passed: Passed) -> None:
        self._simulation = simulation
        self._passed = passed
        self._told = (0, 0, 0)
        self._due_s = 0.0
        simulation.watched.world.watchers.append(self._look)

    def tell(self) -> None:
        """Call it for what passed since."""
        simulation = self._simulation
        minutes = int(simulation.watched.seconds // MINUTE_S)
        so_far = (minutes, simulation.cycles, len(simulation.result.faults))
        self._passed(*(now - before for now, before in zip(so_far, self._told, strict=True)))
        self._told = so_far

    def _look(self) -> None:
        seconds = self._simulation.watched.seconds
        if seconds >= self._due_s:
            self._due_s = seconds + LOOK_S
            self.tell()


def cut_after(simulation: Simulation, seconds: float) -> None:
    """Have the run of a simulation end with TimePassed once so many seconds of plant time have passed."""
    watched = simulation.watched

    def look() -> None:
        if watched.seconds > seconds:
            raise TimePassed

    watched.world.watchers.append(look)
