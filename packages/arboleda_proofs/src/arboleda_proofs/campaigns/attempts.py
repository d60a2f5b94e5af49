"""Attempts to break the same with fewer faults: a campaign of them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.run import MINUTE_S, Result
from arboleda_proofs.simulator.shrink import breaks_alike, explicit

from .campaign import Batch, Crew, Passed, Tick
from .plants import Plant
from .setting import Setting

GRACE_S = 20.0  # of plant time: with fewer faults it may break later by so much


@dataclass(frozen=True, kw_only=True)
class Attempt:
    """Run of one list of faults; `broken`: as the best run so far breaks."""

    number: int
    result: Result
    broken: bool


@dataclass(frozen=True, kw_only=True)
class Attempts:
    """Attempts to break as `best` does, on a plant: one for each of `lists`, by its number."""

    setting: Setting
    plant: Plant
    best: Result
    lists: Sequence[Sequence[Fault]]

    def run(self, seed: int, *, tick: Passed | None = None) -> Attempt:
        """The attempt of this number."""
        result = self.setting.attempt(
            self.plant,
            self.best.seed,
            explicit(self.lists[seed]),
            self.best.minutes * MINUTE_S,
            until_s=until_s(self.best),
            tick=tick,
        )
        return Attempt(number=seed, result=result, broken=breaks_alike(result, self.best))

    def in_turn(self, tick: Tick, crew: Crew) -> Iterator[Result]:
        """Their results in the order of the lists; none begins after one has broken."""
        ended: dict[int, Result] = {}
        following, numbers = 0, range(len(self.lists))
        batch = Batch(runs=self, seeds=numbers, tick=tick, plants=(self.plant,), until_failure=True, ahead=1)
        with crew.campaign(batch) as campaign:
            for attempt in campaign.results():
                ended[attempt.number] = attempt.result
                while following in ended:
                    yield ended.pop(following)
                    following += 1


def until_s(best: Result) -> float:
    """The plant time at which an attempt to break as `best` does ends; inf where that broke at rest."""
    return best.seconds + GRACE_S if best.seconds < best.minutes * MINUTE_S else math.inf
