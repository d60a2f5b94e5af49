"""Checks that a recipe could make: a step by which a cell would notice what nobody does."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from arboleda.model.plant_model import Cell

from .end_state import KNOWN, EndState
from .proof import Proof
from .proof_tally import Case


@dataclass(frozen=True, kw_only=True)
class Check:
    """Check: `steps` of which one would notice it, as a recipe has them; `is_sure`: the plant had been told
    of it, so that a step which waits for the fact sees it; else they are questions that may see it.
    """

    steps: tuple[str, ...]
    is_sure: bool = False


def checks(proof: Proof, case: Case) -> list[Check]:
    """The checks for all that is not so in a case; none where nothing in the cell would notice it."""
    cell = proof.model.cell(case.scenario.cell)
    sure = [Check(steps=(step,), is_sure=True) for step in _facts(case, cell, proof.calm[case.row].state)]
    if len(sure) == len(case.outcome.untrue):
        return sure
    questions = tuple(_questions(cell))
    return [*sure, Check(steps=questions)] if questions else sure


def _facts(case: Case, cell: Cell, expected: EndState) -> Iterator[str]:
    """The steps that wait for facts of which the plant had been told."""
    roles = {robot.name: role for role, robot in cell.members}
    for sentence in case.outcome.untrue:
        what = sentence.partition(" is ")[0]
        robot, _, fact = what.partition(".")
        if sentence.endswith(KNOWN) and what in expected and robot in roles:
            yield f"{roles[robot]}.becomes({fact}={expected[what]!r})"


def _questions(cell: Cell) -> Iterator[str]:
    """The queries of the devices of a cell, then a question to each person."""
    for role, robot in cell.members:
        yield from (f"{role}.{verb}()" for verb in robot.query_names)
    yield from (f"{role}.ask(...)" for role, robot in cell.members if robot.is_asked)
