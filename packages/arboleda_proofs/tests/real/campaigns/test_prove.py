"""A proof finds the same in forks and in several processes as in one."""

from __future__ import annotations

from pathlib import Path

import pytest
from packages.arboleda_proofs.tests.fast.campaigns.lamp import Prove, calm_of, pairs_of, portions, summary
from packages.arboleda_proofs.tests.fast.campaigns.lamp import plant as plant
from packages.arboleda_proofs.tests.fast.campaigns.lamp import prove as prove

from arboleda_proofs.campaigns.proof.course import course_of
from arboleda_proofs.campaigns.proof.forks import CAN_FORK, Walk, run_all, run_one
from arboleda_proofs.campaigns.proof.proof import Proof
from arboleda_proofs.campaigns.proof.single_faults import single_faults

KINDS = ("brown_out", "delay", "plant_crash", "plant_freeze", "lying_fact", "operator_hold")


@pytest.mark.skipif(not CAN_FORK, reason="this system cannot fork")
def test_forks_do_the_same_as_runs_from_the_beginning(plant: Path) -> None:
    model, calm = calm_of(plant)
    proof = Proof(model=model, calm=(calm,), kinds=("brown_out", "partition", "crash_in_step"))
    faults = proof.faults(proof.portions[3])
    forked = run_all(proof.model, calm, faults, lambda: None, forks=True)
    assert faults and forked == run_all(proof.model, calm, faults, lambda: None, forks=False)


@pytest.mark.skipif(not CAN_FORK, reason="this system cannot fork")
def test_a_walk_from_instant_to_instant_does_the_same_as_runs_from_the_beginning(plant: Path) -> None:
    model, calm = calm_of(plant)
    course = course_of(model, calm)
    walk = Walk(model, calm, course)
    for number, instant in enumerate(calm.instants):
        parts = single_faults(model, model.cells[0], instant, number=number, only=KINDS)
        faults = [each for part in parts for each in part]
        assert faults and walk.reaches(instant.at)
        forked = walk.runs([(each,) for each in faults], lambda: None, forks=True)
        assert forked == [run_one(model, calm, each, course=course) for each in faults]
    assert not walk.reaches(calm.instants[0].at)


@pytest.mark.skipif(not CAN_FORK, reason="this system cannot fork")
def test_pairs_do_the_same_in_forks_as_from_the_beginning(plant: Path) -> None:
    pairs = pairs_of(plant, "partition", "refuses")
    first = next(portions(pairs))
    model, calm, both = pairs.proof.model, pairs.proof.calm[0], pairs.pairs(first)[:4]
    forked = Walk(model, calm).runs(both, lambda: None, forks=True)
    assert both and forked == Walk(model, calm).runs(both, lambda: None, forks=False)


def test_any_number_of_processes_gives_the_same(plant: Path, prove: Prove) -> None:
    out = str(plant.parent / "out.json")
    digests = []
    for jobs in ("1", "2"):
        prove("--fault", "reboot", "--anew", "--all-instants", "--jobs", jobs, "--json", out)
        digests.append(summary(plant)["digests"])
    assert digests[0] == digests[1]
    assert len(digests[0]) == 9
