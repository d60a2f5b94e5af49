"""Breaches of a proof: the shortest case of each again, with all that happened."""

from __future__ import annotations

from arboleda.simulator.judged_world import BrokenInvariant
from arboleda.simulator.run import Result

from .forks import run_one
from .proof_tally import Case, ProofTally
from .pytest_file import Breach


def breaches_of(tally: ProofTally) -> list[Breach]:
    """The breaches in a tally, each run again with its timeline."""
    return [_again(tally, case, count) for case, count in tally.breaches()]


def _again(tally: ProofTally, case: Case, count: int) -> Breach:
    """The run of a case once more, with its timeline."""
    proof = tally.proof
    run, stage = run_one(proof.model, proof.calm[case.row], case.fault, keep=True)
    result = Result(seed=0, faults=[case.fault], lines=stage.watched.trace.lines, seconds=run.seconds)
    result.broken = BrokenInvariant(*run.outcome.broken) if run.outcome.broken else None
    return Breach(
        scenario=case.scenario,
        instant=case.instant,
        fault=case.fault,
        run=run,
        count=count,
        result=result,
        stated=stage.stated,
    )
