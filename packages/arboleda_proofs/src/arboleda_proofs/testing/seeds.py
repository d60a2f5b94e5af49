"""One plant under many seeds: tasks, people and faults drawn from each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from arboleda.model.plant_model import PlantModel
from arboleda.model.recipe import Builders
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.invariants import Invariant
from arboleda_proofs.simulator.run import MINUTE_S, Plan, Result, Simulation
from arboleda_proofs.simulator.shrink import explicit, shrink

CYCLES = 20
LEVEL = "normal"


@dataclass(frozen=True, kw_only=True)
class Seeds:
    """Runs with one seed each: so many cycles of a plant, with faults of a level."""

    model: PlantModel
    cycles: int
    level: str
    recipes: Builders
    invariants: tuple[Invariant, ...]

    def run(self, seed: int, *, keep: bool = False) -> Result:
        """Run one seed from its first step to rest; `keep`: with its timeline."""
        climate = Climate.draw(self.model, seed, self.level)
        return self._simulation(seed, climate.faults, keep=keep).run(cycles=self.cycles)

    def shrunk(self, broken: Result) -> Result:
        """The same breach with as few faults as could be found, and its timeline."""

        def attempt(best: Result, faults: Sequence[Fault], *, keep: bool = False) -> Result:
            simulation = self._simulation(best.seed, explicit(faults), keep=keep)
            return simulation.run(seconds=best.minutes * MINUTE_S)

        def attempts(best: Result, lists: Sequence[Sequence[Fault]]) -> Iterator[Result]:
            return (attempt(best, faults) for faults in lists)

        found = shrink(broken, attempts)
        again = attempt(found, found.faults, keep=True)
        return again if again.broken else self.run(broken.seed, keep=True)

    def _simulation(self, seed: int, plan: Plan, *, keep: bool = False) -> Simulation:
        return Simulation(self.model, seed, plan, invariants=self.invariants, keep=keep, recipes=self.recipes)
