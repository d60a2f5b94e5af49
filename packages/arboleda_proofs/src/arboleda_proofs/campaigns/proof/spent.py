"""Time of a processor that the runs of a proof took, and on what."""

from __future__ import annotations

from dataclasses import dataclass, fields

from .outcome import Run


@dataclass(kw_only=True)
class Spent:
    """Spent: times of a processor in s, by what it did; `plant_s` of plant time were judged in `runs` runs.

    `courses_s`: for how the world is without a fault; `walks_s`: for what comes before the fault, which runs
    share; `forks_s`: for copies of the process; `steps_s`: for judged steps. `joined` runs ended as soon as
    they were as the one without a fault.
    """

    courses_s: float = 0.0
    walks_s: float = 0.0
    forks_s: float = 0.0
    steps_s: float = 0.0
    plant_s: float = 0.0
    runs: int = 0
    joined: int = 0

    def add(self, other: Spent) -> None:
        """Add what others took."""
        for each in fields(self):
            setattr(self, each.name, getattr(self, each.name) + getattr(other, each.name))

    def count(self, run: Run, at: float, *, steps_s: float, forks_s: float = 0.0) -> None:
        """Count a run whose fault began `at` s of it."""
        self.steps_s += steps_s
        self.forks_s += forks_s
        self.plant_s += (run.seconds if run.joined_at is None else run.joined_at) - at
        self.runs += 1
        self.joined += run.joined_at is not None

    @property
    def words(self) -> str:
        """The average cost of a run."""
        shared_s = self.courses_s + self.walks_s
        all_s = (self.steps_s + self.forks_s + shared_s, self.steps_s, self.forks_s, shared_s)
        whole, steps, forks, shared = (f"{seconds / self.runs * 1000:,.0f} ms" for seconds in all_s)
        plant, early = f"{self.plant_s / self.runs:,.1f}", f"{self.joined / self.runs:.0%}"
        return (
            f"a run took {whole} of a processor: {steps} to judge {plant} s of the plant, {forks} to fork,"
            f" {shared} for what runs share; {early} ended early, as without the fault"
        )
