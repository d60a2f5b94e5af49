"""Facts between the steps of a recipe, as the plant has heard them, with a fault and without."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from arboleda.model.plant_model import PlantModel
from arboleda_proofs.simulator.faults import Fault

from .calm import Calm, calm_play
from .changed_recipe import with_looks, with_recipe
from .end_state import facts_by_report
from .forks import run_on
from .stage import Stage

Facts = Mapping[str, object]  # by the names of robot and fact


@dataclass(frozen=True, kw_only=True)
class Gap:
    """Gap behind the step of this number and name, with the facts as the plant had heard them there last."""

    number: int
    name: str
    facts: Facts


def other_facts(calm: Sequence[Gap], faulty: Sequence[Gap]) -> Iterator[tuple[Gap, str, object]]:
    """The facts that the plant has heard otherwise with a fault, each behind the first step where that is so:
    the gap, the name of the fact, and its value without the fault.
    """
    with_fault = {each.number: each.facts for each in faulty}
    known: set[str] = set()
    for gap in calm:
        found = with_fault.get(gap.number, {})
        others = [name for name in gap.facts if name in found and found[name] != gap.facts[name]]
        yield from ((gap, name, gap.facts[name]) for name in others if name not in known)
        known.update(others)


def gaps(model: PlantModel, calm: Calm, *faults: Fault) -> list[Gap]:
    """The gaps of a task with these faults, or without any, in the order of the recipe."""
    scenario, found = calm.scenario, dict[int, Gap]()
    recipe = model.cell(scenario.cell).recipe(scenario.recipe)
    stages: list[Stage] = []  # the recipe is part of the plant on it

    def look(number: int, name: str) -> None:
        facts = facts_by_report(stages[0].watched, stages[0].cell)
        found[number] = Gap(number=number, name=name, facts=facts)

    stages.append(Stage(with_recipe(model, scenario.cell, with_looks(recipe, look)), scenario))
    if faults:
        run_on(stages[0], calm, *faults)
    else:
        calm_play(stages[0])
    return [found[number] for number in sorted(found)]
