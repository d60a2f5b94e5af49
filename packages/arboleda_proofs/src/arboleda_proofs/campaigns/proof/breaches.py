"""Breaches of a proof: the shortest case of each again, with all that happened."""

from __future__ import annotations

from arboleda_proofs.simulator.judged_world import BrokenInvariant
from arboleda_proofs.simulator.run import Result

from .forks import run_on
from .moment import Witness
from .pairs import PairTally
from .proof import Proof
from .proof_tally import Case, ProofTally
from .pytest_file import Breach
from .stage import Stage


def breaches_of(tally: ProofTally, pairs: PairTally | None = None) -> list[Breach]:
    """The breaches of single faults, then those of pairs that none of them broke, each run again with its
    timeline.
    """
    found = tally.breaches()
    known = frozenset(case.breaks for case, _ in found if case.breaks)
    found += pairs.breaches(known) if pairs is not None else []
    return [_again(tally.proof, case, count) for case, count in found]


def _again(proof: Proof, case: Case, count: int) -> Breach:
    """The run of a case once more, with its timeline."""
    faults = [case.fault] if case.then is None else [case.fault, case.then]
    calm = proof.calm[case.row]
    stage = Stage(proof.model, calm.scenario, keep=True)
    witness = Witness(stage)
    run = run_on(stage, calm, *faults)
    result = Result(seed=0, faults=faults, lines=stage.watched.trace.lines, seconds=run.seconds)
    result.broken = BrokenInvariant(*run.outcome.broken) if run.outcome.broken else None
    return Breach(
        scenario=case.scenario,
        instant=case.instant,
        fault=case.fault,
        then=case.then,
        run=run,
        count=count,
        result=result,
        stated={what: value for what, value in stage.stated.items() if what in stage.state},
        moment=witness.moment,
    )
