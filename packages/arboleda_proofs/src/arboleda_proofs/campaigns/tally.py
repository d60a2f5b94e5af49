"""Tally of the seeds that have ended, for the screen and for a file."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace
from typing import Any

from arboleda_proofs.simulator.findings import Finding
from arboleda_proofs.simulator.run import NO_EXCEPTION, Result

from .setting import Setting


@dataclass(kw_only=True)
class Tally:
    """Tally: sums, a row per seed, and all details of seeds that broke an invariant."""

    setting: Setting
    rows: dict[int, dict[str, Any]] = field(default_factory=dict)
    broken: dict[int, Result] = field(default_factory=dict)
    faults: Counter[str] = field(default_factory=Counter)
    outcomes: Counter[str] = field(default_factory=Counter)
    findings: Counter[Finding] = field(default_factory=Counter)
    as_written: Counter[Finding] = field(default_factory=Counter)
    cycles: int = 0
    in_vain: int = 0  # seeds in which no task told a device to do anything
    checks: int = 0
    judged: set[str] = field(default_factory=lambda: {NO_EXCEPTION})
    seconds: float = 0.0

    @property
    def lowest(self) -> Result | None:
        """The first seed that broke an invariant, in the order of seeds."""
        return self.broken[min(self.broken)] if self.broken else None

    @property
    def holds(self) -> bool:
        """True where the seeds tried something, and nothing in them was wrong."""
        return not (self.broken or self.findings or self.in_vain)

    def add(self, result: Result) -> None:
        plant = self.setting.plants.of(result.seed)
        faults = Counter(fault.kind for fault in result.faults)
        self.faults.update(faults)
        self.outcomes.update(result.outcomes)
        self.cycles += result.cycles
        self.in_vain += result.in_vain
        _take(self.findings, result.findings, result.seed)
        _take(self.as_written, result.as_written, result.seed)
        self.checks += result.checks.total()
        self.judged |= result.checks.keys()
        self.seconds += result.seconds
        self.rows[result.seed] = {
            "seed": result.seed,
            "plant": plant.name,
            "digest": result.digest,
            "cycles": result.cycles,
            "seconds": round(result.seconds, 3),
            "faults": dict(sorted(faults.items())),
            "outcomes": dict(sorted(result.outcomes.items())),
            **plant.plain,
            "broken": None,
        }
        if result.broken:
            self.broken[result.seed] = result


def _take(found: Counter[Finding], more: Counter[Finding], seed: int) -> None:
    """Add the findings of a seed; each is named with the task and the seed that brought it first."""
    for each, count in more.items():
        found[replace(each, seed=seed)] += count
