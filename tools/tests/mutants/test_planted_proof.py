"""The bugs for `prove` are found by `check`, a calm run or single faults, but for those that are listed."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.lengths import length

from arboleda.plant_file import loader
from arboleda_proofs.campaigns.proof.calm import calm_run
from arboleda_proofs.campaigns.proof.scenario import scenarios

from .planted_proof import MOST, sighted, written
from .proof_bug import PLANTS, ProofBug
from .proof_bugs import BY_FAULTS, EQUAL, NOT_FOUND, PROOF_BUGS

FOUND = [bug for bug in PROOF_BUGS if (bug.plant, bug.about) not in {**NOT_FOUND, **EQUAL}]
AT_ONCE = [bug for bug in FOUND if (bug.plant, bug.about) not in BY_FAULTS]


@pytest.mark.timeout(3600)  # as a whole it takes an hour
@pytest.mark.parametrize(
    "bug", length(AT_ONCE[::11], whole=FOUND), ids=lambda bug: f"{bug.plant} {bug.about[:50]}"
)
def test_a_bug_is_found_by_what_says_nothing_of_its_plant_without_it(tmp_path: Path, bug: ProofBug) -> None:
    assert sighted(tmp_path, bug, length(0, whole=MOST)) is not None


def test_there_are_many_bugs_of_each_plant_and_most_are_found() -> None:
    known = {(bug.plant, bug.about) for bug in PROOF_BUGS}
    assert len(known) == len(PROOF_BUGS) >= 60
    assert {plant for plant, _ in known} == set(PLANTS)
    assert {*NOT_FOUND, *EQUAL, *BY_FAULTS} <= known
    assert len(FOUND) / len(PROOF_BUGS) > 0.93
    assert len(FOUND) / (len(PROOF_BUGS) - len(EQUAL)) >= 0.95


def test_the_virtual_belt_sees_no_part_that_an_arm_puts_down(tmp_path: Path) -> None:
    (bug,) = (each for each in PROOF_BUGS if each.about == "The belt is never told to clear.")
    model = loader.load(written(tmp_path, bug.plant, bug))
    calm = calm_run(model, next(scenarios(model, ["mill"])))  # the camera says good first
    assert (calm.state["parts at belt"], calm.state["belt.entry"]) == (1, "clear")
