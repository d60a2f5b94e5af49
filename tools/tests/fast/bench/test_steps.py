"""The storage recipe as a list: what the floors say is what the plant says."""

from collections.abc import Iterable
from dataclasses import replace

import pytest

from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Command
from arboleda.model.messages import TaskState
from arboleda.model.plant_model import Cell
from arboleda.plant_file.loader import load
from arboleda.rig.rig import Rig
from arboleda.testing.storage_layout import StorageLayout
from arboleda_bench import plants, steps


@pytest.fixture
def model(tmp_path):
    return load(plants.write(tmp_path / "plant.yaml", 1, near=True, link="mqtt", evidence="ids"))


def without_ids(commands: Iterable[object]) -> list[Command]:
    return [replace(each, id="", heard=None, token=None) for each in commands if isinstance(each, Command)]


def test_the_floors_say_what_the_plant_says(model):
    rig, cell = Rig(model), model.cells[0]
    for _ in range(2):  # the first one begins where the mobile robot stands at the start
        rig.wait(1.0)
        del rig.sent[:]
        task = rig.submit(steps.task(cell)).task
        assert rig.wait(60.0, until=lambda task=task: rig.outcomes()[task].state is TaskState.DONE)
    assert without_ids(rig.sent) == without_ids(steps.storage(cell))


def test_goals_differ_in_their_first_coordinate_so_that_a_floor_may_look_at_that_alone(model):
    cell = model.cells[0]
    moves = [step for step in steps.storage(cell) if isinstance(step, FollowPath | MoveJoints)]
    for robot in cell.robots:
        firsts = [steps.end(cell, move)[0] for move in moves if move.robot == robot.name]
        assert all(abs(a - b) > 5e-3 for a in firsts for b in firsts if a is not b)


def test_lengths_fall_evenly_into_every_part_of_their_interval():
    length = steps.lengths(0.25, 0.75)
    found = sorted(length() for _ in range(100))
    tenths = [sum(0.25 + 0.05 * k <= each < 0.30 + 0.05 * k for each in found) for k in range(10)]
    assert min(tenths) >= 9 and max(tenths) <= 11


def test_a_plant_for_short_moves_has_cells_that_are_alike(tmp_path):
    cells = load(plants.write(tmp_path / "two.yaml", 2, near=True, link="ros", evidence="joints")).cells
    assert [(cell.name, StorageLayout(cell).arm.name, StorageLayout(cell).mobile.name) for cell in cells] == [
        ("c1", "a1", "m1"),
        ("c2", "a2", "m2"),
    ]
    assert _poses(cells[0]) == _poses(cells[1])


def _poses(cell: Cell) -> list[tuple[float, ...]]:
    return [pose.q for pose in StorageLayout(cell).space.poses]
