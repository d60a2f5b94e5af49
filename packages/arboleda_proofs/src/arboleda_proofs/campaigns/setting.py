"""Setting of a simulation of many seeds, and the run of one of them; workers get it from the parent."""

from __future__ import annotations

import copyreg
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from arboleda.engine import Plant as CorePlant
from arboleda.model.plant_model import PlantModel
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.invariants import Invariant
from arboleda_proofs.simulator.judged import judged_by
from arboleda_proofs.simulator.judged_world import BrokenInvariant
from arboleda_proofs.simulator.run import NO_EXCEPTION, Plan, Result, Simulation
from arboleda_proofs.simulator.scripted_people import Script, script_from

from .campaign import Passed
from .plants import Plant, Plants
from .under_way import TimePassed, UnderWay, cut_after

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
        tick: Passed | None = None,
        make_plant: MakePlant | None = None,
    ) -> Result:
        """One seed from its first step to rest; `keep` and `tell` are those of the trace.

        `tick` is called for every second that it simulates, `make_plant` makes the plant of each start.
        """
        plant = self.plants.of(seed)
        plan = self.climate(seed).faults
        simulation = self._simulation(plant, seed, plan, keep=keep, tell=tell, make_plant=make_plant)
        under_way = None if tick is None else UnderWay(simulation, tick)
        result = simulation.run(seconds=self.seconds, cycles=self.cycles)
        if under_way is not None:
            under_way.tell()
        _leave_out_intended(result, plant)
        return result

    def attempt(
        self,
        plant: Plant,
        seed: int,
        plan: Plan,
        seconds: float,
        *,
        keep: bool = False,
        until_s: float = math.inf,
        tick: Passed | None = None,
    ) -> Result:
        """A seed on such a plant with these faults, for so long; what has not broken by `until_s` holds."""
        simulation = self._simulation(plant, seed, plan, keep=keep)
        if until_s < math.inf:
            cut_after(simulation, until_s)
        if tick is not None:
            UnderWay(simulation, tick)
        try:
            return simulation.run(seconds=seconds)
        except TimePassed:
            return simulation.result

    def _simulation(self, plant: Plant, seed: int, plan: Plan, **options: Any) -> Simulation:
        return Simulation(
            plant.model,
            seed,
            plan,
            invariants=self._judges(plant),
            script=self.script(plant.model),
            any_of=self.any_of,
            standby=self.standby,
            revises=self.revises,
            **options,
        )

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
