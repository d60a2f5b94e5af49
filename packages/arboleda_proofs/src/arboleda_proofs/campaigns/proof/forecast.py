"""Forecast of a proof: how many runs there are, and how long they take by what runs without faults took."""

from __future__ import annotations

import math
from dataclasses import dataclass

from arboleda.model.counting import counted

from .forks import FORK_TAKES_S
from .proof import Proof


@dataclass(frozen=True, kw_only=True)
class Forecast:
    """Forecast of the runs of a proof that are not `kept` from before; `pace`: seconds of a processor for a
    second of a run without faults. `budget_s` is what is left for them. `share`: the number of all tasks for
    each one that has run.
    """

    proof: Proof
    pace: float
    jobs: int
    budget_s: float = math.inf
    kept: int = 0
    share: float = 1.0

    @property
    def words(self) -> str:
        """The runs that are to be done and their time, in one line."""
        recipes = counted(
            len({(each.scenario.cell, each.scenario.recipe) for each in self.proof.calm}), "recipe"
        )
        runs, cores = counted(self._total - self.kept, "run"), counted(self.jobs, "core")
        enough = self.budget_s / self.seconds if self.seconds else 1.0
        part = f"; --budget is enough for about {enough:.1%}" if enough < 1.0 else ""
        if self.proof.every:
            return f"{recipes}, every instant: about {runs}, {_time(self.seconds)} on {cores}{part}"
        return f"{recipes}, classes of instants: about {runs}, {_time(self.seconds)} on {cores}{part}"

    @property
    def seconds(self) -> float:
        """The time that the runs take on all cores, s: each takes a third of a calm one from its instant on.

        It would take half of that, but many fail soon, or soon are as the calm one again.
        """
        each_s = [self.pace * calm.lasts_s / 3 + FORK_TAKES_S for calm in self.proof.calm]
        all_s = sum(each_s[row] * runs for row, runs in self.proof.by_scenario.items()) * self.share
        return all_s * (1.0 - self.kept / max(self._total, 1)) / self.jobs

    @property
    def _total(self) -> int:
        return round(self.proof.total * self.share)


def _time(seconds: float) -> str:
    if seconds < 60.0:
        return f"{math.ceil(seconds)} s"
    return f"{seconds / 60:,.0f} min" if seconds < 7200.0 else f"{seconds / 3600:,.0f} h"
