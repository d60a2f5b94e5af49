"""Bugs in recipes, trees of files, kinds and tasks with numbers, each found on a small plant of devices."""

from __future__ import annotations

from dataclasses import dataclass

import pytest
import yaml

from arboleda.kinds.declared import FactType
from arboleda.model.plant_model import PlantModel
from arboleda.model.recipe import Limits
from arboleda.recipes.decorators import Again, Times
from arboleda_drawn.plants import loaded
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.invariants import Invariant
from arboleda_proofs.simulator.judged import INVARIANTS
from arboleda_proofs.simulator.run import Simulation
from arboleda_trees.bt_xml.running.decorators import Loop

from .mutant import Edit, edit

SEEDS = range(1, 26)
FILE = """
    name: workshop
    uses: [kinds.py, recipes.py, tries.xml, repeats.xml]
    cells: {bench: {devices: {saw: {kind: saw}}}}
"""
BESIDE = {
    "kinds.py": '''
"""A saw whose blade goes down to a depth."""

from dataclasses import dataclass

from arboleda.kinds import Kind, Number, kind, motion


@dataclass(frozen=True, kw_only=True)
class Saw:
    """What the plant file may say of a saw."""


@kind("saw")
def saw(settings: Saw) -> Kind:
    depth = Number(0, 9)
    verbs = {"lower": motion(parameters={"to": depth}, sets={"depth": "$to"}, takes_s=0.5)}
    return Kind(facts={"depth": depth}, verbs=verbs)
''',
    "recipes.py": '''
"""What a bench does."""

from arboleda.recipes import Number, recipe


@recipe("insists")
def insists(cell):
    return cell.retry(cell.device("saw").lower(to=3), times=1, pause_s=0.1)


@recipe("repeats_it")
def repeats_it(cell):
    return cell.repeat(cell.device("saw").lower(to=9), 2)


@recipe("rests")
def rests(cell, seconds=Number(1, 5)):
    return cell.wait(seconds)
''',
    "tries.xml": """
<root BTCPP_format="4" main_tree_to_execute="Tries">
  <BehaviorTree ID="Tries">
    <RetryUntilSuccessful num_attempts="2"><saw_lower to="4"/></RetryUntilSuccessful>
  </BehaviorTree>
</root>
""",
    "repeats.xml": """
<root BTCPP_format="4" main_tree_to_execute="Repeats">
  <BehaviorTree ID="Repeats"><Repeat num_cycles="2"><saw_lower to="9"/></Repeat></BehaviorTree>
</root>
""",
}


@dataclass(frozen=True, kw_only=True)
class Bug:
    """Bug as an edit, the invariant that finds it, and the weather for that, faults per minute."""

    edit: Edit
    invariant: str
    rates: dict[str, float]


BUGS = {
    "one retry too many": Bug(
        edit=edit(Again.update, "self.tries >= self.times", "self.tries > self.times"),
        invariant="retries_bounded",
        rates={"gives_up": 6.0},
    ),
    "one turn too many": Bug(
        edit=edit(Times.update, "self.done >= self.times", "self.done > self.times"),
        invariant="retries_bounded",
        rates={},
    ),
    "one round of a file too many": Bug(
        edit=edit(Loop.work, "while self.rounds < most or", "while self.rounds <= most or"),
        invariant="retries_bounded",
        rates={},
    ),
    "no upper limit of a number in a task": Bug(
        edit=edit(Limits.reads, "self.lower <= number <= self.upper", "self.lower <= number"),
        invariant="numbers_lie_within_their_limits",
        rates={"bad_task": 10.0},
    ),
    "no lower limit of a number in a task": Bug(
        edit=edit(Limits.reads, "self.lower <= number <= self.upper", "number <= self.upper"),
        invariant="numbers_lie_within_their_limits",
        rates={"bad_task": 10.0},
    ),
    "no upper limit of a number that a device says": Bug(
        edit=edit(FactType.takes, "self.lower <= value <= self.upper", "self.lower <= value"),
        invariant="believed_as_said",
        rates={"lying_fact": 10.0},
    ),
}


@pytest.fixture(scope="module")
def workshop() -> PlantModel:
    return loaded(yaml.safe_load(FILE), BESIDE).model


def broken(model: PlantModel, seed: int, rates: dict[str, float], judges: tuple[Invariant, ...]) -> str:
    climate = Climate.from_file(model, seed, {"rates": rates})
    found = Simulation(model, seed, climate.faults, invariants=judges).run(seconds=60.0).broken
    return found.invariant if found else ""


@pytest.mark.parametrize("bug", BUGS.values(), ids=BUGS)
def test_a_bug_is_found_by_its_invariant_and_nothing_without_it(bug: Bug, workshop: PlantModel) -> None:
    judges = tuple(each for each in INVARIANTS if each.name == bug.invariant)
    with pytest.MonkeyPatch.context() as patch:
        bug.edit.make(patch)
        found = next((seed for seed in SEEDS if broken(workshop, seed, bug.rates, judges)), None)
    assert found is not None
    assert broken(workshop, found, bug.rates, INVARIANTS) == ""
