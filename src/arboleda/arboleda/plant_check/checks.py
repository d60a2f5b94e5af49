"""Check of a plant whose file is good: all that people are warned of."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from arboleda.model.plant_model import Cell, Evidence, PlantModel
from arboleda.plant_file import loader
from arboleda.plant_file.declared_kinds import verbs_of
from arboleda.plant_file.problems import counted
from arboleda.recipes.authoring import WrittenRecipe

from . import advance_check, form_checks, grid_check, layout_check, meeting_points, place_check

OTHERWISE = "; write another evidence"


def warnings(plant: PlantModel) -> tuple[str, ...]:
    """The warnings of all checks; a warning that several cells share is one sentence that names them all."""
    sentences = [sentence for check in CHECKS for sentence in check(plant)]
    roles = {cell.name: {device.name: role for role, device in cell.members} for cell in plant.cells}
    return counted(sentences, roles)


def unmet_needs(plant: PlantModel) -> tuple[str, ...]:
    """A sentence for each verb that is always refused: it needs a fact that its device never reports."""
    return tuple(f"{cell.name}: {sentence}" for cell in plant.cells for sentence in _unmet(cell))


def unused_steps(plant: PlantModel) -> tuple[str, ...]:
    """A sentence for each step that gets a name in a recipe in Python and stands nowhere, with its place.

    The steps were noted when the recipe was tried with all its parameters.
    """
    recipes = [recipe for cell in plant.cells for recipe in cell.recipes]
    unused = [each for recipe in recipes if isinstance(recipe, WrittenRecipe) for each in recipe.unused]
    return tuple(dict.fromkeys(unused))


def _unmet(cell: Cell) -> Iterator[str]:
    silent = {each.name for each in cell.robots if each.evidence is Evidence.STATE}
    own = [
        (device.name, verb.name, device.name, fact)
        for device in cell.robots
        for verb in verbs_of(device).values()
        for fact, _ in verb.needs
    ]
    of_others = [(each.device, each.word, each.other, each.fact) for each in cell.needs]
    for device, word, other, fact in (*own, *of_others):
        if other in silent:
            why = f"{other} reports no facts (evidence: state)"
            yield f"{device} {word} needs {fact} of {other}, and {why}; it is always refused" + OTHERWISE


CHECKS: tuple[Callable[[PlantModel], tuple[str, ...]], ...] = (
    loader.warnings,
    layout_check.warnings,
    meeting_points.warnings,
    grid_check.warnings,
    place_check.warnings,
    unmet_needs,
    unused_steps,
    advance_check.warnings,
    form_checks.warnings,
)
