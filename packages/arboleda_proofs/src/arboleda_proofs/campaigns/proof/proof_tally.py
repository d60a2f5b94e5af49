"""Tally of a proof: what came of each kind of fault in each recipe, what broke, and what nobody notices."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Container, Iterable, Iterator
from dataclasses import dataclass, field

from arboleda_proofs.simulator.faults import Fault

from .instants import Instant
from .outcome import Outcome
from .proof import Portion, Proof, Proved
from .scenario import Scenario

RecipeKey = tuple[str, str]  # cell, recipe
Breaks = tuple[str, str, str]  # an invariant, cell, recipe


@dataclass(frozen=True, kw_only=True)
class Case:
    """Case: one fault at one instant of one scenario, and its outcome; of a pair `then` is the other one."""

    scenario: Scenario
    row: int  # of the calm run
    instant: Instant
    fault: Fault
    outcome: Outcome
    then: Fault | None = None

    @property
    def breaks(self) -> Breaks | None:
        """The rule that it breaks; None where it breaks none."""
        broken = self.outcome.broken
        return (broken[0], self.scenario.cell, self.scenario.recipe) if broken is not None else None


@dataclass(frozen=True, kw_only=True)
class Form:
    """Form of a fault in a scenario: all but its moment, which of some kinds is the number of a commit."""

    target: str
    word: str
    seconds: float
    scenario: str


@dataclass(kw_only=True)
class Row:
    """Row of the table: a kind of fault in a recipe."""

    runs: int = 0
    alone: int = 0
    ends: Counter[str] = field(default_factory=Counter)
    causes: Counter[str] = field(default_factory=Counter)
    unnoticed: int = 0
    broken: int = 0
    by_form: dict[Form, list[tuple[Instant, float, str]]] = field(default_factory=dict)

    @property
    def changes(self) -> bool:
        """True if the end of one and the same fault changes with the moment."""
        return any(len({words for *_, words in ends}) > 1 for ends in self.by_form.values())

    @property
    def turns(self) -> dict[str, list[tuple[Instant, str]]]:
        """For each target the form that changes most often: its outcome at first, then each other one with
        the first instant that has it.
        """
        found: dict[str, list[tuple[Instant, str]]] = {}
        for form, ends in self.by_form.items():
            turns = _turns(ends)
            if len(turns) > max(1, len(found.get(form.target, ()))):
                found[form.target] = turns
        return found


@dataclass(kw_only=True)
class ProofTally:
    """ProofTally: `cases` in a fixed order, of all portions that are `proved`, by number.

    `is_cut`: there are tasks of which nothing is known, as they did not even run without faults.
    """

    proof: Proof
    proved: dict[int, Proved] = field(default_factory=dict)
    is_cut: bool = False

    def cases(self) -> Iterator[Case]:
        """All cases, task by task, of each in the order of the instants."""
        known = [(self.proof.portions[number], proved) for number, proved in self.proved.items()]
        for portion, proved in sorted(known, key=lambda each: _place(each[0])):
            scenario = self.proof.calm[portion.scenario].scenario
            rows = zip(self.proof.faults(portion), proved.each, strict=True)
            for fault, outcome in rows:
                yield Case(
                    scenario=scenario,
                    row=portion.scenario,
                    instant=self.proof.instant(portion),
                    fault=fault,
                    outcome=outcome,
                )

    def table(self) -> dict[RecipeKey, dict[str, Row]]:
        """A row for each kind of fault, by recipe."""
        found: dict[RecipeKey, dict[str, Row]] = {}
        for case in self.cases():
            rows = found.setdefault((case.scenario.cell, case.scenario.recipe), {})
            _add(rows.setdefault(case.fault.kind, Row()), case)
        return found

    def breaches(self) -> list[tuple[Case, int]]:
        """For each invariant that a recipe broke its earliest case, and how many there are."""
        return shortest(self.cases())

    def unnoticed(self) -> list[tuple[Case, int]]:
        """For each kind of fault on each target that a task is done in spite of: a case, and how many."""
        found: dict[tuple[str, ...], list[Case]] = {}
        for case in self.cases():
            if case.outcome.goes_unnoticed and case.outcome.broken is None:
                key = (case.scenario.cell, case.scenario.recipe, case.fault.kind, case.fault.target)
                found.setdefault(key, []).append(case)
        return [(cases[0], len(cases)) for cases in found.values()]

    def unmended(self) -> list[tuple[Case, int]]:
        """For each kind of fault on each target after which few acts do not get a cell ready: the worst case,
        and how many.
        """
        found: dict[tuple[str, ...], list[Case]] = {}
        for case in self.cases():
            if case.outcome.takes_too_much:
                key = (case.scenario.cell, case.scenario.recipe, case.fault.kind, case.fault.target)
                found.setdefault(key, []).append(case)
        return [(max(cases, key=_acts), len(cases)) for cases in found.values()]

    @property
    def most_acts(self) -> int:
        """The most acts that a cell needed of a person until it was ready."""
        each = (outcome.acts or 0 for proved in self.proved.values() for outcome in proved.outcomes)
        return max(each, default=0)

    @property
    def runs(self) -> int:
        """The number of runs so far."""
        return sum(len(each.rows) for each in self.proved.values())

    def is_whole(self, total: int) -> bool:
        """True if all runs are done, which are so many, of all tasks."""
        return 0 < self.runs == total and not self.is_cut

    @property
    def alone(self) -> float:
        """The share of runs after which the cell got ready again without a person."""
        alone = sum(each.alone for proved in self.proved.values() for each in proved.each)
        return alone / max(self.runs, 1)


def shortest(cases: Iterable[Case], known: Container[Breaks] = ()) -> list[tuple[Case, int]]:
    """For each of what cases break its earliest case, and how many there are; none of what is `known`."""
    found: dict[Breaks, list[Case]] = {}
    for case in cases:
        if case.breaks is not None and case.breaks not in known:
            found.setdefault(case.breaks, []).append(case)
    return [(min(each, key=_shortness), len(each)) for each in found.values()]


def _place(portion: Portion) -> tuple[int, int, int, int]:
    return portion.scenario, portion.instant, portion.part, portion.first


def _acts(case: Case) -> float:
    return math.inf if case.outcome.acts is None else case.outcome.acts


def _shortness(case: Case) -> tuple[int, float, float]:
    """The order of stories: plain answers, an early moment, a short fault."""
    return len(case.scenario.answers), case.fault.at, case.fault.seconds


def _add(row: Row, case: Case) -> None:
    outcome, fault = case.outcome, case.fault
    row.runs += 1
    row.alone += outcome.alone
    row.ends[outcome.end.value] += 1
    if outcome.cause:
        row.causes[outcome.cause] += 1
    row.unnoticed += outcome.goes_unnoticed
    row.broken += outcome.broken is not None
    form = Form(
        target=fault.target,
        word=fault.word,
        seconds=fault.seconds,
        scenario=case.scenario.name,
    )
    row.by_form.setdefault(form, []).append((case.instant, fault.amount, outcome.words))


def _turns(ends: Iterable[tuple[Instant, float, str]]) -> list[tuple[Instant, str]]:
    found: list[tuple[Instant, str]] = []
    for instant, _, words in sorted(ends, key=lambda each: (each[0].at, each[1])):
        if not found or found[-1][1] != words:
            found.append((instant, words))
    return found
