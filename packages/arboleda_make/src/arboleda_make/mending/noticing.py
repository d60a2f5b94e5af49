"""Mend for what nobody notices: a check in the recipe, with which the task is no longer called done."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

from arboleda.extension import ArboledaError
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_check.mend import Cut, Mend, Texts, edit_of, edited
from arboleda.plant_file import loader
from arboleda.plant_file.draft import shaded
from arboleda.recipes import WrittenRecipe
from arboleda_proofs.campaigns.plants import Plant
from arboleda_proofs.campaigns.proof.changed_recipe import noticed_with
from arboleda_proofs.campaigns.proof.checks import checks
from arboleda_proofs.campaigns.proof.proof_tally import Case, ProofTally

from .search import sources, texts_of

MOST_CASES = 4  # that a check is looked for


def noticing_mend(file: Path, tally: ProofTally, *, within_s: float) -> Mend | None:
    """The first check of those that are known to notice a fault, at a place in the recipe's file where it
    does; None where there is none, or not within this time.
    """
    texts, ends_at = texts_of(file), time.monotonic() + within_s
    for case, _ in tally.unnoticed()[:MOST_CASES]:
        for cuts, step in _places(texts, tally, case):
            if time.monotonic() >= ends_at:
                return None
            edits = tuple(edit_of(texts, each) for each in cuts)
            if _notices(file, edited(texts, edits), case):
                sentence = f"{edits[0].file}:{edits[0].line}: {step}"
                gone = tuple(f"{case.scenario.name}: nobody notices {each}" for each in case.outcome.untrue)
                return Mend(sentence=sentence, edits=edits, mends=gone, left=len(tally.unnoticed()) - 1)
    return None


def _places(texts: Texts, tally: ProofTally, case: Case) -> Iterator[tuple[tuple[Cut, ...], str]]:
    """Each known check at each place of a recipe in Python, the last ones first."""
    recipe = tally.proof.model.cell(case.scenario.cell).recipe(case.scenario.recipe)
    sure = [step for each in checks(tally.proof, case) if each.is_sure for step in each.steps]
    if not sure or not isinstance(recipe, WrittenRecipe):
        return
    name = recipe.function.__name__
    for source in sources(texts):
        found = [each for each in source.elements if each.function.name == name]
        for step in sure:
            role, _, call = step.partition(".")
            for element in reversed(found):
                handle = source.handle_of(role, element.function)
                if handle is not None and element.siblings:
                    yield source.after(element, f"{handle}.{call}"), step


def _notices(file: Path, texts: Texts, case: Case) -> bool:
    """True where the task with these texts is done without the fault, and not with it."""
    contents = {name: text.encode() for name, text in texts.items()}
    with shaded(PlantFiles(plant=file.name, contents=contents), file) as shade:
        try:
            model = Plant(declared=loader.load(shade.plant_file, apart=False)).model
            recipe = model.cell(case.scenario.cell).recipe(case.scenario.recipe)
            return noticed_with(model, case.scenario, recipe, [case.fault]) is not None
        except ArboledaError:
            return False
