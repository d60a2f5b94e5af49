"""An assistant without any model, which only follows the answers, mends most of the planted bugs."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.lengths import length

from .followed_mends import MENDED, followed, judged
from .planted_proof import written
from .proof_bug import ProofBug
from .proof_bugs import PROOF_BUGS
from .unmended import MEASURED, UNMENDED

BUGS = [bug for bug in PROOF_BUGS if bug.plant in MEASURED]
MENDS = [bug for bug in BUGS if (bug.plant, bug.about) not in UNMENDED]
QUICK = [bug for bug in MENDS if bug.plant == "lab_bench"]


@pytest.mark.timeout(3600)  # as a whole it takes hours
@pytest.mark.parametrize(
    "bug", length(QUICK[::5], whole=MENDS), ids=lambda bug: f"{bug.plant} {bug.about[:50]}"
)
def test_a_bug_is_mended_by_what_check_and_prove_answer(tmp_path: Path, bug: ProofBug) -> None:
    assert judged(tmp_path, bug).verdict == MENDED


def test_what_is_good_already_is_left_as_it_is(tmp_path: Path) -> None:
    assert followed(written(tmp_path, "lab_bench")) == ()


def test_two_of_three_bugs_are_mended() -> None:
    assert UNMENDED.keys() <= {(bug.plant, bug.about) for bug in BUGS}
    assert len(MENDS) / len(BUGS) > 2 / 3
