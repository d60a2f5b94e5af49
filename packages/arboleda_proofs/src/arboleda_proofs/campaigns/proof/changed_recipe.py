"""Recipe that was changed by a check: whether its task then notices faults, and is done without them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Composite

from arboleda.drivers import Value
from arboleda.engine import Context
from arboleda.model.plant_model import PlantModel
from arboleda.recipes import Order, Recipe, Step
from arboleda.recipes.handles import Handle
from arboleda_proofs.simulator.faults import Fault

from .calm import Calm, calm_run
from .forks import run_on
from .outcome import IS_DONE, Outcome
from .scenario import Scenario
from .stage import Stage

WITHIN_S = 2  # at_most_s of a check


def noticed_with(
    model: PlantModel, scenario: Scenario, recipe: Recipe, faults: Sequence[Fault]
) -> Outcome | None:
    """Outcome with these faults where a cell has this recipe in the place of the one of its name.

    None where the recipe disturbs the task without them, or where nobody notices them all the same.
    """
    changed = with_recipe(model, scenario.cell, recipe)
    calm = calm_run(changed, scenario)
    if not calm.is_sound or calm.run.outcome.end not in IS_DONE:
        return None
    found = outcome_with(changed, scenario, calm, faults)
    return None if found.goes_unnoticed or found.broken else found


def outcome_with(model: PlantModel, scenario: Scenario, calm: Calm, faults: Sequence[Fault]) -> Outcome:
    """Outcome of a task with these faults."""
    return run_on(Stage(model, scenario), calm, *faults).outcome


def with_check(recipe: Recipe, role: str, fact: str, value: Value, *, behind: int | None = None) -> Recipe:
    """A recipe that waits until the device in a role says so of a fact: at its end, or `behind` the step of
    its work that has this number.
    """

    def build(order: Order, context: Context) -> Step:
        tree = recipe.build(order, context)
        device = Handle(context.cell.roles[role], context)
        check, steps = device.becomes(at_most_s=WITHIN_S, **{fact: value}), work_of(tree)
        steps.insert_child(check, len(steps.children) if behind is None else behind + 1)
        return tree

    return replace(recipe, build=build)


def with_looks(recipe: Recipe, look: Callable[[int, str], None]) -> Recipe:
    """A recipe that calls `look` with the number and the name of each step of its work once that is done."""

    def build(order: Order, context: Context) -> Step:
        tree = recipe.build(order, context)
        steps = work_of(tree)
        for number, step in reversed([*enumerate(steps.children)][1:]):  # the first is the start of the task
            steps.insert_child(_Look(partial(look, number, step.name)), number + 1)
        return tree

    return replace(recipe, build=build)


class _Look(Behaviour):
    """Look between two steps, which takes no time and always succeeds."""

    def __init__(self, look: Callable[[], None]) -> None:
        super().__init__("look")
        self._look = look

    def update(self) -> Status:
        self._look()
        return Status.SUCCESS


def work_of(tree: Step) -> Composite:
    """The work in the tree of a recipe: what comes before, then its steps; beside it is the recovery."""
    work = tree.children[0]
    assert isinstance(work, Composite)
    return work


def with_recipe(model: PlantModel, cell: str, recipe: Recipe) -> PlantModel:
    """The plant with another recipe in the place of the one of its name in a cell."""
    before = model.cell(cell)
    recipes = tuple(recipe if each.name == recipe.name else each for each in before.recipes)
    after = replace(before, recipes=recipes)
    return replace(model, cells=tuple(after if each is before else each for each in model.cells))
