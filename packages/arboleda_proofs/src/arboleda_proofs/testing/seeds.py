"""One plant under many seeds: tasks, people and faults drawn from each."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.model.plant_model import PlantModel
from arboleda.model.recipe import Builders
from arboleda_proofs.simulator.climate import Climate
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

        def attempt(plan: Plan, seconds: float, *, keep: bool = False) -> Result:
            return self._simulation(broken.seed, plan, keep=keep).run(seconds=seconds)

        found = shrink(broken, attempt)
        again = attempt(explicit(found.faults), found.minutes * MINUTE_S, keep=True)
        return again if again.broken else self.run(broken.seed, keep=True)

    def _simulation(self, seed: int, plan: Plan, *, keep: bool = False) -> Simulation:
        return Simulation(self.model, seed, plan, invariants=self.invariants, keep=keep, recipes=self.recipes)
