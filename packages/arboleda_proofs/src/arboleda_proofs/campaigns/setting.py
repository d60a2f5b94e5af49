"""Setting of a simulation of many seeds, and the run of one of them; workers get it from the parent."""

from __future__ import annotations

import copyreg
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from arboleda.engine import Plant as CorePlant
from arboleda.model.plant_model import PlantModel
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.invariants import Invariant
from arboleda_proofs.simulator.judged import judged_by
from arboleda_proofs.simulator.judged_world import BrokenInvariant
from arboleda_proofs.simulator.run import NO_EXCEPTION, Plan, Result, Simulation
from arboleda_proofs.simulator.scripted_people import Script, script_from

from .campaign import Tick as Tick
from .plants import Plant, Plants

Tell = Callable[[str], None]
MakePlant = Callable[..., CorePlant]

copyreg.pickle(BrokenInvariant, lambda broken: (BrokenInvariant, (broken.invariant, broken.sentence)))


@dataclass(frozen=True, kw_only=True)
class Setting:
    """`plants` says on which one a seed runs; faults are drawn at `level`, or are those of `faults_data`.

    A run goes on until `cycles` tasks have ended, or for `seconds` if given. With `any_of` about half of the
    tasks are for several cells. `standby`: the plant runs on two hosts. `revises`: its files
    are changed while it runs.
    """

    plants: Plants
    cycles: int
    level: str
    faults_data: Any = None  # what Climate.from_file and script_from take
    seconds: float | None = None
    any_of: bool = False
    standby: bool = False
    revises: bool = False

    def plant(self, seed: int) -> PlantModel:
        """The plant of a seed as it is simulated."""
        return self.plants.of(seed).model

    def climate(self, seed: int) -> Climate:
        """The faults of a seed; BadFaults where those that are told cannot be."""
        if self.faults_data is not None:
            return Climate.from_file(self.plant(seed), seed, self.faults_data, standby=self.standby)
        return Climate.draw(self.plant(seed), seed, self.level, standby=self.standby)

    def script(self, plant: PlantModel) -> Script | None:
        """The acts of people if the file has some; BadFaults if they are impossible."""
        return script_from(plant, self.faults_data)

    def run(
        self,
        seed: int,
        *,
        keep: bool = False,
        tell: Tell | None = None,
        tick: Tick | None = None,
        make_plant: MakePlant | None = None,
    ) -> Result:
        """One seed from its first step to rest; `keep` and `tell` are those of the trace.

        `tick` is called for every minute that it simulates, `make_plant` makes the plant of each start.
        """
        drawn = self.climate(seed).faults

        def plan(minute: int) -> Iterable[Fault]:
            if tick is not None:
                tick()
            return drawn(minute)

        model = self.plant(seed)
        script = self.script(model)
        simulation = Simulation(
            model,
            seed,
            plan,
            invariants=self._judges(self.plants.of(seed)),
            keep=keep,
            tell=tell,
            make_plant=make_plant,
            script=script,
            any_of=self.any_of,
            standby=self.standby,
            revises=self.revises,
        )
        result = simulation.run(seconds=self.seconds, cycles=self.cycles)
        _leave_out_intended(result, self.plants.of(seed))
        return result

    def attempt(self, plant: Plant, seed: int, plan: Plan, seconds: float, *, keep: bool = False) -> Result:
        """A seed on such a plant with these faults, for so long."""
        script = self.script(plant.model)
        simulation = Simulation(
            plant.model,
            seed,
            plan,
            invariants=self._judges(plant),
            keep=keep,
            script=script,
            any_of=self.any_of,
            standby=self.standby,
            revises=self.revises,
        )
        return simulation.run(seconds=seconds)

    def _judges(self, plant: Plant) -> tuple[Invariant, ...]:
        return (*judged_by(standby=self.standby, revises=self.revises), *plant.rules)


def _leave_out_intended(result: Result, plant: Plant) -> None:
    for finding in filter(plant.intends, list(result.findings)):
        del result.findings[finding]


def rules(plant: Plant | None = None) -> dict[str, str]:
    """The sentence of each invariant, by its name, with those of a plant."""
    judges = (*judged_by(standby=True, revises=True), *(plant.rules if plant else ()))
    sentences = {each.name: " ".join(each.sentence.split()) for each in judges}
    return {NO_EXCEPTION: "No exception escapes a step."} | sentences
