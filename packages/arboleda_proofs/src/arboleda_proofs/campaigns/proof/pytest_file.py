"""Tests for pytest, with the fixture `sim`, that do again what broke an invariant."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.run import Result

from ..words import fault_said
from .end_state import EndState
from .instants import Instant
from .moment import Moment
from .outcome import Run
from .scenario import Scenario
from .stage import ASKED_AT_S, ENDS_AS_SAID


@dataclass(frozen=True, kw_only=True)
class Breach:
    """Breach: the run of one fault again, with its timeline; `count` cases broke the same of this recipe.

    `then`: the other one of a pair. `stated`: the facts with which the recipe says that it ends. `moment`:
    the tree and the devices when it broke.
    """

    scenario: Scenario
    instant: Instant
    fault: Fault
    run: Run
    count: int
    result: Result
    stated: EndState = field(default_factory=dict)
    then: Fault | None = None
    moment: Moment = field(default_factory=Moment)

    @property
    def faults(self) -> list[Fault]:
        """The faults that began, as long as they lasted."""
        both = [self.fault] if self.then is None else [self.fault, self.then]
        return [
            lasting(each, self.run) for each in both if each is self.fault or each.at < self.run.mended_at
        ]

    @property
    def befell(self) -> str:
        """The faults in words."""
        then = "" if self.then is None else f", then {fault_said(self.then)} at {self.then.at:.3f} s"
        return f"{fault_said(self.fault)}{then}"


def as_tests(breaches: Iterable[Breach], plant: Path | None) -> str:
    """A file with a test for each breach, which fails as long as the invariant is broken."""
    head = ["from arboleda_proofs.simulator.faults import Fault", ""]
    return "\n".join([*head, *(line for each in breaches for line in ["", *_test(each, plant)])]) + "\n"


def lasting(fault: Fault, run: Run) -> Fault:
    """The fault as long as it lasted in its run: it is mended once the task has ended."""
    return replace(fault, seconds=min(fault.seconds, max(0.0, run.mended_at - fault.at)))


def _test(breach: Breach, plant: Path | None) -> list[str]:
    broken = breach.run.outcome.broken
    name, sentence = broken or ("", "")
    answers = ", ".join(f"{who}={word!r}" for who, word in breach.scenario.answers)
    rest = breach.run.attended_at - ASKED_AT_S
    return [
        f"def test_{_identifier(breach)}(sim):",
        *[f"    # {line}" for line in (f"{name}: {sentence}", breach.instant.name)],
        f"    sim.plant({'' if plant is None else repr(plant.name)})",
        f"    sim.answer_always({answers})",
        f"    sim.run({ASKED_AT_S})",
        *_brought(breach.scenario),
        f"    task = sim.submit({breach.scenario.task!r})",
        f"    sim.faults([{', '.join(map(_written, breach.faults))}])",
        f"    sim.run({rest!r})",
        *_ends(breach),
        "    sim.rest()",
        "",
    ]


def _brought(scenario: Scenario) -> Iterator[str]:
    """The lines with which people bring what the task needs."""
    for place in scenario.brought:
        yield f'    sim.operate("load", {scenario.cell!r}, place={place!r})'


def _ends(breach: Breach) -> Iterator[str]:
    """The lines that ask for the facts with which a task that is done is to end."""
    if breach.run.outcome.broken and breach.run.outcome.broken[0] == ENDS_AS_SAID:
        for what, value in breach.stated.items():
            robot, _, fact = what.partition(".")
            yield f"    assert task.state != 'done' or sim.robot({robot!r}).facts[{fact!r}] == {value!r}"


def _written(fault: Fault) -> str:
    fields = {"kind": fault.kind, "at": fault.at, "seconds": fault.seconds, "target": fault.target}
    fields |= {"amount": fault.amount, "word": fault.word}
    return f"Fault({', '.join(f'{key}={value!r}' for key, value in fields.items())})"


def _identifier(breach: Breach) -> str:
    broken = breach.run.outcome.broken or ("",)
    words = f"{breach.scenario.cell}_{breach.scenario.recipe}_{breach.fault.kind}_{broken[0]}"
    return re.sub(r"\W", "_", words)
