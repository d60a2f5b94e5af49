"""Search for the fewest faults, and the least of a plant, that still break an invariant."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda_proofs.simulator.checks import BadFaults
from arboleda_proofs.simulator.faults import KINDS, Fault
from arboleda_proofs.simulator.run import MINUTE_S, Plan, Result
from arboleda_proofs.simulator.shrink import Progress, explicit, shrink

from .plants import Plant
from .setting import Setting

ATTEMPTS = 250  # runs on smaller plants, at most


@dataclass(frozen=True, kw_only=True)
class ShrunkBreach:
    """A breach reduced to its needs: its run, with the lines of its last seconds, and the plant."""

    result: Result
    plant: Plant


def shrunk(setting: Setting, broken: Result, progress: Progress) -> ShrunkBreach:
    """The same breach with as few faults, and as little of its plant, as could be found."""
    search = _Search(setting, broken, progress)
    search.fewer_faults()
    if search.smaller_plant():
        search.fewer_faults()
    found, plant = search.best, search.plant
    again = setting.attempt(plant, broken.seed, explicit(found.faults), found.minutes * MINUTE_S, keep=True)
    if again.broken:
        return ShrunkBreach(result=again, plant=plant)
    return ShrunkBreach(result=setting.run(broken.seed, keep=True), plant=setting.plants.of(broken.seed))


class _Search:
    """`best` is the smallest run found that breaks the same, on `plant`."""

    def __init__(self, setting: Setting, broken: Result, progress: Progress) -> None:
        self.best = broken
        self.plant = setting.plants.of(broken.seed)
        self._setting = setting
        self._progress = progress
        self._runs = 0

    def fewer_faults(self) -> None:
        """Leave out faults, as long as what remains still breaks."""
        self.best = shrink(self.best, self._on_this_plant, self._progress)

    def smaller_plant(self) -> bool:
        """Leave out part after part of the plant, again while that helps; True if any could go."""
        found, at = False, 0
        while self._runs < ATTEMPTS:
            rest = list(self.plant.smaller())[at:]
            taken = next((number for number, less in enumerate(rest) if self._breaks(less)), None)
            if taken is not None:
                at, found = at + taken, True
            elif at > 0:
                at = 0  # what was needed before may not be needed any more
            else:
                break
        return found

    def _on_this_plant(self, plan: Plan, seconds: float) -> Result:
        return self._setting.attempt(self.plant, self.best.seed, plan, seconds)

    def _breaks(self, less: Callable[[], Plant]) -> bool:
        try:
            plant = less()
            self._setting.script(plant.model)
        except (ConfigError, BadFaults):
            return False
        if self._runs >= ATTEMPTS or self.best.broken is None:
            return False
        self._runs += 1
        plan = explicit(_possible(self.best.faults, plant.model))
        found = self._setting.attempt(plant, self.best.seed, plan, self.best.minutes * MINUTE_S)
        same = found.broken is not None and found.broken.invariant == self.best.broken.invariant
        if same:
            self.best, self.plant = found, plant
        self._progress(self._runs, len(self.best.faults))
        return same


def _possible(faults: Sequence[Fault], model: PlantModel) -> list[Fault]:
    """The faults that can befall a plant that has less in it."""
    return [fault for fault in faults if KINDS[fault.kind].objection(fault, model) is None]
