"""Proof of one recipe inside of a test: every single fault, as many runs as are allowed."""

from __future__ import annotations

from arboleda.model.plant_model import PlantModel
from arboleda_proofs.campaigns.plants import ELSEWHERE
from arboleda_proofs.campaigns.proof.breaches import breaches_of
from arboleda_proofs.campaigns.proof.calm import calm_runs
from arboleda_proofs.campaigns.proof.proof import Proof
from arboleda_proofs.campaigns.proof.proof_tally import ProofTally
from arboleda_proofs.campaigns.proof.pytest_file import Breach
from arboleda_proofs.campaigns.proof.scenario import scenarios
from arboleda_proofs.campaigns.proof.single_faults import possible_kinds

from . import wording
from .words import known

RUNS = 500
__tracebackhide__ = True


def prove(model: PlantModel, recipe: str, *, kinds: tuple[str, ...], at_most: int | None) -> float:
    """Raise AssertionError where a run breaks an invariant; return the share of all runs that was run."""
    name = known("a recipe", recipe, _recipes(model))
    only = tuple(known("a kind of fault", each, [kind.name for kind in possible_kinds()]) for each in kinds)
    proof = _proof(model.on_boards(*ELSEWHERE), name, only)
    tally = ProofTally(proof=proof)
    for number in range(len(proof.portions)):
        if at_most is not None and tally.runs >= at_most:
            break
        tally.proved[number] = proof.run(number)
    for each in breaches_of(tally):
        raise AssertionError("\n".join(_story(each)))
    return tally.runs / max(proof.total, 1)


def _recipes(model: PlantModel) -> list[str]:
    return list(dict.fromkeys(each.name for cell in model.cells for each in cell.recipes))


def _proof(model: PlantModel, recipe: str, kinds: tuple[str, ...]) -> Proof:
    calm = tuple(calm_runs(model, scenarios(model, [recipe])))
    for each in calm:
        if not each.is_sound:
            broken = each.run.outcome.broken
            why = ": ".join(broken) if broken else f"{each.run.outcome.words}: {each.finding or each.why}"
            raise AssertionError(f"{each.scenario.name}: without any fault {why}")
    return Proof(model=model, calm=calm, kinds=kinds)


def _story(breach: Breach) -> list[str]:
    name, sentence = breach.run.outcome.broken or ("", "")
    return [
        f"{breach.scenario.name} breaks {name}: {sentence}",
        f"the fault: {breach.befell}, {breach.instant.name}",
        "",
        *wording.timeline(breach.result.lines),
    ]
