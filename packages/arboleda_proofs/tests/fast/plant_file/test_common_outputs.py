"""Outputs that cells share, judged by the simulator."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.unit.plant_file.test_common_outputs import rack

from arboleda.model.plant_model import PlantModel
from arboleda_proofs.simulator.invariants.part_places import PLACES
from arboleda_proofs.simulator.run import Simulation
from arboleda_proofs.simulator.scripted_people import script_from


def after(plant: PlantModel, *tasks: str) -> tuple[list[int], dict[str, int]]:
    """The parts in the rack by the books of both cells, and how many tasks ended so; nothing is broken."""
    people = [{"at": 2.0 + 10 * number, "task": task} for number, task in enumerate(tasks)]
    script = script_from(plant, {"people": people, "seconds": 60})
    simulation = Simulation(plant, 1, lambda minute: (), script=script, invariants=PLACES)
    result = simulation.run()
    assert result.broken is None, result.broken
    cells = simulation.world.plant.cells
    return [cells[name].context.places.counts["rack"] for name in ("press", "wash")], dict(result.outcomes)


@pytest.mark.parametrize(
    ("tasks", "parts", "outcomes"),
    [
        (["press make", "press make"], 2, {"done": 2}),
        (["press make", "press make", "wash clean", "press make"], 2, {"done": 4}),
        (["press make", "press make", "wash clean", "wash clean"], 0, {"done": 4}),
    ],
)
def test_what_one_cell_puts_the_other_takes(
    tmp_path: Path, tasks: list[str], parts: int, outcomes: dict[str, int]
) -> None:
    assert after(rack(tmp_path), *tasks) == ([parts, parts], outcomes)


def test_nothing_is_put_beyond_the_room_there(tmp_path: Path) -> None:
    outcomes = after(rack(tmp_path), *["press make"] * 3)[1]
    assert outcomes == {"done": 2, "precondition": 1}
