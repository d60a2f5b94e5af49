"""The judge of exercises: every right work passes, every wrong one does not, with what was seen instead."""

from __future__ import annotations

import pytest

from arboleda_class.exercises.exercise import catalog

from .works import Sample, samples

WORKS = list(samples())


@pytest.mark.parametrize("work", WORKS, ids=str)
def test_a_work_is_judged_as_it_is(work: Sample) -> None:
    verdict = work.judged()
    assert verdict.passes == work.right, verdict.findings
    proofs = catalog()[work.exercise].proving
    if work.right:
        assert verdict.runs >= len(catalog()[work.exercise].trials) + sum(each.runs // 2 for each in proofs)
    else:
        assert verdict.findings[0].evidence
