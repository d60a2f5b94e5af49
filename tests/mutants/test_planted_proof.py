"""The bugs for `prove` are found by `check`, a calm run or single faults, but for those that are listed."""

from __future__ import annotations

from pathlib import Path

import pytest

from ..lengths import length
from .planted_proof import MOST, sighted
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
