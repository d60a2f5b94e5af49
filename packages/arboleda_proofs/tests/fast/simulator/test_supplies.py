"""Supplies that people fill and empty are not left behind by a task."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.plants import read
from tests.unit.kinds.test_places import PLANT, recipe_of

from arboleda.model.messages import Verb
from arboleda.trees.asked_places import AskedPlaces
from arboleda_proofs.simulator.faults.kind import Fault
from arboleda_proofs.simulator.invariants.part_places import PLACES
from arboleda_proofs.simulator.judged_world import JudgedWorld
from arboleda_proofs.simulator.run import Simulation

FROM_A_DEVICE = PLANT.replace("inside: {of: oven}", "inside: {of: oven, supply: true}")


@pytest.mark.long
def test_a_task_may_empty_a_supply_of_a_device(tmp_path: Path) -> None:
    model = read(tmp_path, FROM_A_DEVICE, recipe_of('take("inside"), put("bin"), mover.home()'))
    result = Simulation(model, 1, lambda minute: [], invariants=PLACES).run(cycles=2)
    assert result.broken is None
    assert result.outcomes == {"done": result.cycles}


def test_it_may_not_empty_a_device_that_people_do_not_fill(tmp_path: Path) -> None:
    body = 'take("rack_1"), put("inside"), mover.home()'
    result = Simulation(read(tmp_path, PLANT, recipe_of(body)), 1, lambda minute: [], invariants=PLACES)
    broken = result.run(cycles=2).broken
    assert broken is not None
    assert broken.invariant == "done_tasks_leave_nothing_behind"


OUTPUT = PLANT.replace("inside: {of: oven}", "inside: {of: oven, output: true}")
LEAVES_A_PART = 'take("rack_1"), put("inside"), mover.home(), cell.fail("not today")'


@pytest.mark.parametrize("asks", [True, False])
def test_nobody_empties_an_output_that_a_failed_task_has_left_full_unasked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, asks: bool
) -> None:
    if not asks:
        monkeypatch.setattr(AskedPlaces, "fail", lambda self: None)
    model = read(tmp_path, OUTPUT, recipe_of(LEAVES_A_PART))
    broken = Simulation(model, 1, lambda minute: [], invariants=PLACES).run(cycles=2).broken
    assert (broken is None) is asks
    assert asks or broken.sentence == "hand lets go of a part at inside, which has 1 already"


RESTING = """
@recipe("rest")
def rest(cell):
    return work(cell.device("mover").home(), cell.wait(6))
"""


def test_a_task_does_not_answer_for_a_hand_that_closes_late_on_a_command_of_before_it(tmp_path: Path) -> None:
    recipes = recipe_of('cell.fallback(take("rack_1"), cell.wait(0.2))') + RESTING
    plant = read(tmp_path, PLANT.replace("at_most_s: 1", "at_most_s: 6"), recipes)
    watched = JudgedWorld(plant, invariants=PLACES)
    world = watched.world
    watched.begin(Fault(at=0.0, kind="ends_late", target="hand", amount=7.3, seconds=60.0))
    world.request_task("lab try")
    world.request_task("lab rest")
    world.advance(20.0)
    assert [task.state.value for task in world.plant.intake.tasks.values()] == ["done", "done"]
    assert watched.truth.places.cells["lab"].late_hands == {"hand"}
    assert world.boards["hand"].body.facts["closed"]


def test_nobody_knows_what_a_hand_has_that_closes_late_on_its_way(tmp_path: Path) -> None:
    plant = PLANT.replace("at_most_s: 1", "at_most_s: 2")
    plant = plant.replace("[-60, 10], mm: 80", "[-60, 10], mm: 80, approach_mm: 40")
    watched = JudgedWorld(read(tmp_path, plant, recipe_of('take("nest")')), invariants=PLACES)
    world, places = watched.world, watched.truth.places.cells["lab"]
    watched.begin(Fault(at=0.0, kind="ends_late", target="hand", amount=2.5, seconds=5.5))
    world.request_verb(Verb.LOAD, "lab", arguments=(("place", "nest"),))
    world.request_task("lab try")
    assert world.advance(8.0, lambda: places.is_doubtful)
    assert world.boards["hand"].body.facts["closed"] and not watched.truth.robots["mover"].here
    world.advance(8.0)  # by the books it is brought back meanwhile
    assert not world.boards["hand"].body.facts["closed"]
    assert world.plant.cells["lab"].context.places.counts["nest"] == 1
