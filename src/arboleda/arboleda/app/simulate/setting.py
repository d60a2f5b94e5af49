"""What a simulation of many seeds is about, and how one of them is run; workers get it from the parent."""

from __future__ import annotations

import copyreg
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from arboleda.core.model import PlantModel
from arboleda.simulator.climate import Climate
from arboleda.simulator.faults import Fault
from arboleda.simulator.invariants import INVARIANTS
from arboleda.simulator.run import MINUTE_S, NO_EXCEPTION, Broken, Plan, Result, Simulation
from arboleda.simulator.shrink import Progress, explicit, shrink

Tell = Callable[[str], None]
Tick = Callable[[], None]

copyreg.pickle(Broken, lambda broken: (Broken, (broken.invariant, broken.sentence)))


@dataclass(frozen=True, kw_only=True)
class Setting:
    """`plants` take turns by seed; faults are drawn at `level`, or are as `told`.

    A run goes on until `cycles` tasks have ended, or for `seconds` where they are given.
    """

    plants: tuple[PlantModel, ...]
    cycles: int
    level: str
    told: Any = None  # what Climate.from_file takes
    seconds: float | None = None

    def plant(self, seed: int) -> PlantModel:
        return self.plants[seed % len(self.plants)]

    def climate(self, seed: int) -> Climate:
        """The faults of a seed; BadFaults where those that are told cannot be."""
        if self.told is not None:
            return Climate.from_file(self.plant(seed), seed, self.told)
        return Climate.draw(self.plant(seed), seed, self.level)

    def run(
        self, seed: int, *, keep: bool = False, tell: Tell | None = None, tick: Tick | None = None
    ) -> Result:
        """One seed from its first step to rest; `keep` and `tell` are those of the trace.

        `tick` is called for every minute that it simulates.
        """
        drawn = self.climate(seed).faults

        def plan(minute: int) -> Iterable[Fault]:
            if tick is not None:
                tick()
            return drawn(minute)

        simulation = self._simulation(seed, plan, keep=keep, tell=tell)
        return simulation.run(seconds=self.seconds, cycles=self.cycles)

    def shrunk(self, broken: Result, progress: Progress) -> Result:
        """The same breach with as few faults as could be found, and the lines of its last seconds."""
        seed = broken.seed
        found = shrink(broken, lambda plan, s: self._simulation(seed, plan).run(seconds=s), progress)
        again = self._simulation(seed, explicit(found.faults), keep=True).run(
            seconds=found.minutes * MINUTE_S
        )
        return again if again.broken else self.run(seed, keep=True)

    def _simulation(
        self, seed: int, plan: Plan, *, keep: bool = False, tell: Tell | None = None
    ) -> Simulation:
        return Simulation(self.plant(seed), seed, plan, invariants=INVARIANTS, keep=keep, tell=tell)


def rules() -> dict[str, str]:
    """What must hold: a sentence by the name of each invariant."""
    sentences = {each.name: " ".join(each.sentence.split()) for each in INVARIANTS}
    return {NO_EXCEPTION: "No exception escapes a step."} | sentences
