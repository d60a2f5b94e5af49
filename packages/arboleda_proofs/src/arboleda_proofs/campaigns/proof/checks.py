"""Checks that a recipe could make: a step by which a cell would notice what nobody does.

A step that waits for a fact is tried: the task with it is done without the fault, and not with it. First at
the end of the recipe, then behind each step of its work where the plant had heard otherwise with the fault.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice

from arboleda.drivers import Value
from arboleda.extension import ArboledaError
from arboleda.model.plant_model import Cell
from arboleda_proofs.simulator.faults.targets import queries

from .between_steps import gaps, other_facts
from .changed_recipe import WITHIN_S, noticed_with, with_check
from .end_state import KNOWN, EndState
from .proof import Proof
from .proof_tally import Case

MOST_TRIED = 4  # facts between steps, of one fault


@dataclass(frozen=True, kw_only=True)
class Check:
    """Check: `steps` of which one would notice it, as a recipe has them; `is_sure`: it was tried, at the end
    of the recipe, or `behind` a step of it; else they are questions that may see it.
    """

    steps: tuple[str, ...]
    is_sure: bool = False
    behind: str = ""


def checks(proof: Proof, case: Case) -> Sequence[Check]:
    """The checks for all that is not so in a case; none where nothing in the cell would notice it."""
    key = (case.row, case.fault)
    if key not in proof.checked:
        proof.checked[key] = tuple(_checks(proof, case))
    return proof.checked[key]


def tried_checks(proof: Proof, case: Case) -> Sequence[Check] | None:
    """The checks of a case; None where they were not tried, as there was no time."""
    return proof.checked.get((case.row, case.fault))


def _checks(proof: Proof, case: Case) -> Iterator[Check]:
    cell = proof.model.cell(case.scenario.cell)
    known = [*_facts(case, cell, proof.calm[case.row].state)]
    sure = [each for each in known if _notices(proof, case, *each)]
    yield from (Check(steps=(_step(*each),), is_sure=True) for each in sure)
    between = None if sure else _between_steps(proof, case, cell)
    yield from () if between is None else (between,)
    questions = tuple(_questions(cell))
    if questions and len(sure) < len(case.outcome.untrue):
        yield Check(steps=questions)


def _step(role: str, fact: str, value: Value) -> str:
    return f"{role}.becomes({fact}={value!r}, at_most_s={WITHIN_S})"


def _between_steps(proof: Proof, case: Case, cell: Cell) -> Check | None:
    """The check behind the earliest step at which it notices the fault; None where none does."""
    model, calm, roles = proof.model, proof.calm[case.row], {robot.name: role for role, robot in cell.members}
    others = other_facts(gaps(model, calm), gaps(model, calm, case.fault))
    for gap, name, value in islice(others, MOST_TRIED):
        robot, _, fact = name.partition(".")
        if not isinstance(value, bool | int | float | str):
            continue
        check = roles[robot], fact, value
        if _notices(proof, case, *check, behind=gap.number):
            return Check(steps=(_step(*check),), is_sure=True, behind=f"{gap.number}, {gap.name}")
    return None


def _notices(
    proof: Proof, case: Case, role: str, fact: str, value: Value, *, behind: int | None = None
) -> bool:
    """True if a step behind the work of the recipe, or `behind` one of its steps, notices the fault."""
    scenario = case.scenario
    recipe = proof.model.cell(scenario.cell).recipe(scenario.recipe)
    changed = with_check(recipe, role, fact, value, behind=behind)
    try:
        return noticed_with(proof.model, scenario, changed, [case.fault]) is not None
    except ArboledaError:  # no such step in this cell
        return False


def _facts(case: Case, cell: Cell, expected: EndState) -> Iterator[tuple[str, str, Value]]:
    """The facts of which the plant had been told, with what they should be: role, fact, value."""
    roles = {robot.name: role for role, robot in cell.members}
    for sentence in case.outcome.untrue:
        what = sentence.partition(" is ")[0]
        robot, _, fact = what.partition(".")
        value = expected.get(what)
        if sentence.endswith(KNOWN) and robot in roles and isinstance(value, bool | int | float | str):
            yield roles[robot], fact, value


def _questions(cell: Cell) -> Iterator[str]:
    """The queries of the devices of a cell, then a question to each person."""
    for role, robot in cell.members:
        yield from (f"{role}.{verb}()" for verb in queries(robot))
    yield from (f"{role}.ask(...)" for role, robot in cell.members if robot.is_person)
