"""Proof: single faults at instants of all scenarios of a plant, as numbered parts of the work."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from hashlib import blake2b
from typing import Any, TypeVar

from arboleda.model.plant_model import PlantModel
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.recurring import Recurring

from .calm import Calm
from .course import Course, course_of
from .forks import Walk
from .instants import Instant
from .outcome import Outcome, Run
from .representatives import Representatives
from .scenario import Scenario
from .spent import Spent

T = TypeVar("T")
Tick = Callable[[], None]
MOST = 8  # faults of a portion: once begun, it goes on when the budget is over
FEW = 64  # runs of a scenario, which go to their ends: to know how the world is without a fault takes longer
RANKS = (0, 1, 1, 1, 2, 3)  # of the parts of an instant


@dataclass(frozen=True, kw_only=True)
class Portion:
    """Portion of the work: faults of one part at one instant of one scenario, by their numbers."""

    scenario: int
    instant: int
    part: int
    first: int


@dataclass(frozen=True, kw_only=True)
class Proved:
    """Proved portion: its different outcomes, which of them each fault has, and all traces as one hash.

    `spent` is what it took; None where it was kept from before.
    """

    number: int
    outcomes: tuple[Outcome, ...]
    rows: tuple[int, ...]
    digest: str
    spent: Spent | None = field(default=None, compare=False)

    @property
    def broken(self) -> bool:
        """True if a fault broke an invariant."""
        return any(each.broken for each in self.outcomes)

    @property
    def each(self) -> list[Outcome]:
        """The outcome of each fault."""
        return [self.outcomes[row] for row in self.rows]


@dataclass(frozen=True, kw_only=True)
class Proof:
    """Proof of a plant: calm runs that are sound, and `portions` in the order in which they are worth it.

    `kinds`: only faults of these; none: of all. `every`: at every instant, not at one of each class. `seen`:
    also faults that devices had.
    """

    model: PlantModel
    calm: Sequence[Calm] = field(default_factory=tuple)
    kinds: tuple[str, ...] = ()
    every: bool = False
    seen: Sequence[Recurring] = ()

    @cached_property
    def portions(self) -> list[Portion]:
        """All portions: one fault of each kind at each step first, then one form of each on each target, then
        all other forms; of each the beginnings of steps first.

        Portions of one rank come in sweeps over all tasks and instants, so that a short budget meets each. Of
        a sweep each goes on from where the one before it was.
        """
        ranks: dict[tuple[int, bool], list[Portion]] = {}
        for part, level, portion in self._ranked():
            ranks.setdefault((RANKS[part], level > 0), []).append(portion)
        return [each for rank in sorted(ranks) for each in spread(ranks[rank])]

    def instant(self, portion: Portion) -> Instant:
        """The instant at which the faults of a portion begin."""
        return self.calm[portion.scenario].instants[portion.instant]

    def scenario(self, number: int) -> Scenario:
        """The scenario of the portion of this number."""
        return self.calm[self.portions[number].scenario].scenario

    def name(self, number: int) -> str:
        """The name of the portion of this number: its task, and its faults with their times as one hash."""
        faults = blake2b(repr(self.faults(self.portions[number])).encode(), digest_size=16).hexdigest()
        scenario = self.scenario(number)
        return f"{scenario.cell} | {scenario.recipe} | {scenario.name} | {faults}"

    def number(self, name: str) -> int:
        """The number of the portion of this name; KeyError where there is none."""
        return self._numbers[name]

    @cached_property
    def _with_course(self) -> frozenset[int]:
        """The numbers of the portions for which the course of the calm run is worth its time."""
        runs, found = Counter[int](), set[int]()
        for number, portion in enumerate(self.portions):
            if runs[portion.scenario] >= FEW:
                found.add(number)
            runs[portion.scenario] += self.count(number)
        return frozenset(found)

    def _course(self, row: int) -> Course:
        """The course of the calm run of this number."""
        if row not in self._courses:
            began = time.process_time()
            self._courses[row] = course_of(self.model, self.calm[row])
            self._unsaid.courses_s += time.process_time() - began
        return self._courses[row]

    @cached_property
    def _courses(self) -> dict[int, Course]:
        return {}

    @cached_property
    def _unsaid(self) -> Spent:
        """The cost of courses that no portion has counted yet."""
        return Spent()

    @cached_property
    def checked(self) -> dict[tuple[int, Fault], Sequence[Any]]:
        """The checks that were tried for a fault in a scenario, by its number."""
        return {}

    @cached_property
    def _numbers(self) -> dict[str, int]:
        return {self.name(number): number for number in range(len(self.portions))}

    def count(self, number: int) -> int:
        """The number of runs of the portion of this number."""
        return len(self.faults(self.portions[number]))

    def faults(self, portion: Portion) -> list[Fault]:
        """The faults of a portion."""
        parts = self._parts[portion.scenario, portion.instant]
        return parts[portion.part][portion.first : portion.first + MOST]

    def singles(self, row: int) -> list[tuple[Instant, Fault]]:
        """All faults of the scenario of this number, in the order of their instants."""
        instants = self.calm[row].instants
        return [
            (instant, fault)
            for number, instant in enumerate(instants)
            for part in self._parts.get((row, number), ())
            for fault in part
        ]

    @property
    def _parts(self) -> dict[tuple[int, int], list[list[Fault]]]:
        """The faults of each instant of each scenario, in their parts."""
        return self._tried.parts

    @cached_property
    def _tried(self) -> Representatives:
        return Representatives(
            model=self.model, calm=self.calm, kinds=self.kinds, every=self.every, seen=self.seen
        )

    @cached_property
    def total(self) -> int:
        """The number of all runs."""
        return self.by_scenario.total()

    @cached_property
    def by_scenario(self) -> Counter[int]:
        """The number of runs of each scenario, by its number."""
        counts = Counter[int]()
        for (row, _), parts in self._parts.items():
            counts[row] += sum(map(len, parts))
        return counts

    @property
    def represented(self) -> int:
        """The number of single faults at all instants, for which all runs stand."""
        return self._tried.total

    @property
    def is_at_every_instant(self) -> bool:
        """True where each fault is tried at every instant, and no run stands for another one."""
        return self.total == self.represented

    def _ranked(self) -> Iterator[tuple[int, int, Portion]]:
        for (row, number), parts in self._parts.items():
            level = self.calm[row].instants[number].level
            for part, faults in enumerate(parts):
                for first in range(0, len(faults), MOST):
                    yield part, level, Portion(scenario=row, instant=number, part=part, first=first)

    def run(self, seed: int, *, tick: Tick | None = None) -> Proved:
        """Run all faults of the portion of this number."""
        portion = self.portions[seed]
        course = self._course(portion.scenario) if seed in self._with_course else None
        walk = self._walk(portion.scenario, self.instant(portion).at, course)
        runs = walk.runs([(each,) for each in self.faults(portion)], tick or (lambda: None))
        spent = walk.spent()
        spent.courses_s, self._unsaid.courses_s = self._unsaid.courses_s, 0.0
        return proved_by(seed, runs, spent)

    def _walk(self, row: int, at: float, course: Course | None) -> Walk:
        """The walk along the calm run of this number that still comes to `at` s; there is one at a time."""
        key = row, course is not None
        walk = self._walks.get(key)
        if walk is None or not walk.reaches(at):
            self._walks.clear()
            walk = self._walks[key] = Walk(self.model, self.calm[row], course)
        return walk

    @cached_property
    def _walks(self) -> dict[tuple[int, bool], Walk]:
        return {}


def spread(items: Sequence[T]) -> list[T]:
    """The items in sweeps, each in their order, and each with those between the ones of the sweeps before."""
    turns: dict[int, None] = {}
    for power in reversed(range(len(items).bit_length())):
        turns |= dict.fromkeys(range(0, len(items), 2**power))
    return [items[turn] for turn in turns]


def proved_by(number: int, runs: Sequence[Run], spent: Spent) -> Proved:
    """The portion of this number, with these runs, which took so much."""
    outcomes = {run.outcome: None for run in runs}
    numbers = {outcome: index for index, outcome in enumerate(outcomes)}
    digest = blake2b("".join(run.digest for run in runs).encode(), digest_size=16).hexdigest()
    return Proved(
        number=number,
        outcomes=tuple(outcomes),
        rows=tuple(numbers[run.outcome] for run in runs),
        digest=digest,
        spent=spent,
    )
