"""Trial of a plant file with its recipes, each of which is built for each task that it could have."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from arboleda.model.plant_model import Cell
from arboleda.model.recipe import Recipe

from . import drivers, extensions, own_recipes
from .document import Document
from .loader import plant_of
from .python_uses import Watch
from .recipe_check import RecipeTrial
from .recipe_trial import TrialResult


def trial(name: str, content: bytes, folder: Path | None, watch: Watch) -> TrialResult:
    """The problems of a plant file and of its recipes, which are built for each task that they could have.

    The plant's Python files run in this process, whatever they do to it. `recipe_trial` calls this function
    in a process of its own.
    """
    document, result = Document(name, content, folder), TrialResult()

    def tried(cells: Sequence[Cell]) -> dict[str, tuple[Recipe, ...]]:
        trial = RecipeTrial(document=document, used=used, watch=watch)
        result.offers = trial.run(cells)
        result.missed, result.unused = trial.missed, trial.unused
        return {}

    used = own_recipes.imported(document, own_recipes.listed(document), watch)
    plant_of(document, used, tried)
    drivers.driver_uses(document, used)
    extensions.settings_given(document, used)
    result.here, result.elsewhere = document.problems
    return result
