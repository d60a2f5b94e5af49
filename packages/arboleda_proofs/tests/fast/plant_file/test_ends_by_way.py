"""Ends that depend on the way a recipe went, judged by the simulator."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest
from tests.unit.plant_check.test_ends_by_way import BY_ANSWER, PLANT, SWAPPED, sorting

from arboleda.model.plant_model import PlantModel
from arboleda_proofs.simulator.invariants.part_places import PLACES
from arboleda_proofs.simulator.people import FixedAnswers
from arboleda_proofs.simulator.run import Simulation
from arboleda_proofs.simulator.scripted_people import script_from

LENT = PLANT.replace("camera: {kind: camera}", "camera: {shared: camera}").replace(
    "cells:", "shared: {camera: {kind: camera}}\ncells:"
)


MAY_ASK = """
from arboleda.recipes import Choice, recipe, work

@recipe("sort", ends_with=ENDS)
def sort(cell, how=Choice("look", "blind")):
    arm, jaw, camera = cell.devices("arm", "jaw", "camera")
    take, put = arm.visit("in", jaw.close(width_mm=30, force_n=20)), arm.visit("press", jaw.open())
    if how == "blind":
        return work(cell.using("camera", take, put), arm.home())
    seen = camera.look()
    ways = {"good": put, "bad": arm.visit("reject", jaw.open())}
    return work(take, seen, cell.choose(seen, ways), arm.home())
"""


def judged(plant: PlantModel, answer: str, tasks: Sequence[str] = ("a sort",)) -> str | None:
    """The rule that one of these tasks breaks, where the camera gives this answer."""
    people = [{"at": 2.0 + 30 * number, "task": task} for number, task in enumerate(tasks)]
    script = script_from(plant, {"people": people, "seconds": 30 * len(tasks)})
    simulation = Simulation(plant, 1, lambda minute: (), script=script, invariants=PLACES)
    FixedAnswers(simulation.world, {"camera": answer})
    result = simulation.run()
    return result.broken and result.broken.sentence


@pytest.mark.parametrize("answer", ["good", "bad"])
def test_the_simulator_judges_the_end_of_the_way_that_was_gone(tmp_path: Path, answer: str) -> None:
    assert judged(sorting(tmp_path, BY_ANSWER), answer) is None
    place = {"good": "press", "bad": "reject"}[answer]
    sentence = f"t-1000-1 is called done, and {place} is 0, not 1"
    assert judged(sorting(tmp_path, BY_ANSWER, SWAPPED), answer) == sentence


@pytest.mark.parametrize("plant", [PLANT, LENT], ids=["its own", "shared"])
def test_an_answer_to_an_earlier_task_does_not_say_which_end_is_meant(tmp_path: Path, plant: str) -> None:
    model = sorting(tmp_path, BY_ANSWER, recipe=MAY_ASK, plant=plant)
    assert judged(model, "bad", ["a sort look", "a sort blind"]) is None
