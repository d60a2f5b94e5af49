"""Search for the fewest faults, and the least of a plant, that still break an invariant."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from arboleda.extension import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda_proofs.simulator.checks import BadFaults
from arboleda_proofs.simulator.faults import KINDS, Fault
from arboleda_proofs.simulator.run import MINUTE_S, Result
from arboleda_proofs.simulator.shrink import Progress, breaks_alike, explicit, shrink

from .attempts import Attempts, until_s
from .campaign import Crew, Tick
from .plants import Plant
from .setting import Setting

ATTEMPTS = 250  # runs on smaller plants, at most


@dataclass(frozen=True, kw_only=True)
class ShrunkBreach:
    """A breach reduced to its needs: its run, with the lines of its last seconds, and the plant.

    `complete`: False after Ctrl-C, when less may do.
    """

    result: Result
    plant: Plant
    complete: bool = True


def shrunk(
    setting: Setting, broken: Result, progress: Progress, *, tick: Tick = lambda: None, crew: Crew
) -> ShrunkBreach:
    """The same breach with as few faults, and as little of its plant, as could be found, or until Ctrl-C.

    `progress` is called after every run, `tick` now and then.
    """
    search = _Search(setting, broken, progress, tick, crew)
    complete = False
    try:
        search.fewer_faults()
        if search.smaller_plant():
            search.fewer_faults()
        complete = True
    except KeyboardInterrupt:
        pass  # what was found until here is told
    best, plant = search.best, search.plant
    again = setting.attempt(plant, broken.seed, explicit(best.faults), best.minutes * MINUTE_S, keep=True)
    if not again.broken:
        again, plant = setting.run(broken.seed, keep=True), setting.plants.of(broken.seed)
    return ShrunkBreach(result=again, plant=plant, complete=complete)


class _Search:
    """`best` is the smallest run found that breaks the same, on `plant`."""

    def __init__(self, setting: Setting, broken: Result, progress: Progress, tick: Tick, crew: Crew) -> None:
        self.best = broken
        self.plant = setting.plants.of(broken.seed)
        self._setting = setting
        self._progress = progress
        self._tick = tick
        self._crew = crew
        self._runs = 0

    def fewer_faults(self) -> None:
        """Leave out faults, as long as what remains still breaks."""
        shrink(self.best, self._on_this_plant, self._better)

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

    def _on_this_plant(self, best: Result, lists: Sequence[Sequence[Fault]]) -> Iterator[Result]:
        attempts = Attempts(setting=self._setting, plant=self.plant, best=best, lists=lists)
        return attempts.in_turn(self._tick, self._crew)

    def _better(self, runs: int, best: Result) -> None:
        self.best = best
        self._progress(runs, best)

    def _breaks(self, less: Callable[[], Plant]) -> bool:
        try:
            plant = less()
            self._setting.script(plant.model)
        except (ConfigError, BadFaults):
            return False
        if self._runs >= ATTEMPTS:
            return False
        self._runs += 1
        plan = explicit(_possible(self.best.faults, plant.model))
        seconds = self.best.minutes * MINUTE_S
        found = self._setting.attempt(plant, self.best.seed, plan, seconds, until_s=until_s(self.best))
        same = breaks_alike(found, self.best)
        if same:
            self.best, self.plant = found, plant
        self._progress(self._runs, self.best)
        return same


def _possible(faults: Sequence[Fault], model: PlantModel) -> list[Fault]:
    """The faults that can befall a plant that has less in it."""
    return [fault for fault in faults if KINDS[fault.kind].objection(fault, model) is None]
