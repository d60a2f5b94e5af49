"""Recipes that ask places of other cells for parts, judged by the simulator."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.plants import read
from tests.unit.kinds.test_asked_places import PLANT, RECIPES

from arboleda.plant_check import advance_check
from arboleda_proofs.simulator.judged_world import JudgedWorld
from arboleda_proofs.simulator.run import Simulation


def ends(watched: JudgedWorld) -> list[tuple[str, str]]:
    """States of the tasks, each with the sentence of its failure."""
    tasks = watched.world.plant.intake.tasks.values()
    return [(each.state.value, "" if each.failure is None else str(each.failure.sentence)) for each in tasks]


def test_a_cell_waits_for_the_part_that_the_other_one_brings_and_leaves_the_arm_to_it(tmp_path: Path) -> None:
    watched = JudgedWorld(read(tmp_path, PLANT, RECIPES))
    watched.world.request_task("right take")
    watched.world.advance(1.0)
    assert watched.world.plant.zones.holder("arm") is None
    watched.world.request_task("left give")
    watched.world.advance(12.0)
    assert ends(watched) == [("done", ""), ("done", "")]
    assert watched.truth.places.cells["right"].parts == {"pass": 0, "out_1": 1}


def test_a_question_to_a_place_has_a_way_for_each_answer(tmp_path: Path) -> None:
    watched = JudgedWorld(read(tmp_path, PLANT, RECIPES))
    watched.world.request_task("left give")
    watched.world.advance(6.0)
    watched.world.request_task("left give")
    watched.world.advance(1.0)
    assert ends(watched) == [("done", ""), ("done", "")]
    assert watched.world.plant.cells["left"].context.places.counts["pass"] == 1


def test_a_wait_for_a_part_that_does_not_come_names_its_place(tmp_path: Path) -> None:
    watched = JudgedWorld(read(tmp_path, PLANT, RECIPES))
    watched.world.request_task("right take")
    watched.world.advance(9.0)
    assert ends(watched) == [("failed", "no part came to pass within 8 s")]


@pytest.mark.long
def test_nothing_is_found_in_two_cells_that_hand_parts_over(tmp_path: Path) -> None:
    model = read(tmp_path, PLANT, RECIPES.replace("at_most_s=8", "at_most_s=60"))
    assert advance_check.warnings(model) == ()
    result = Simulation(model, 2, lambda minute: []).run(cycles=4)
    assert result.broken is None and not result.findings and result.outcomes["deadline"] == 1
