"""Paths and a handover of a cell of devices: the same cell as by the short form, and what is refused."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from arboleda.core.plant import Plant
from arboleda.model.messages import TaskState
from arboleda.model.plant_model import Cell
from arboleda.model.sentence import NOTHING
from arboleda.recipes import Kit, RecipeError
from arboleda.recipes.handles import Step
from arboleda.testing import Rig

from ...plants import plant_text, read

SHORT = plant_text(__file__, "handovers_short")
LONG = plant_text(__file__, "handovers")


def of_targets(cell: Cell) -> object:
    """What recipes see of a cell, without what its poses are called."""
    spaces = [
        (space.robot, space.returns, space.paths, {name: pose.q for name, pose in space.targets.items()})
        for space in cell.spaces
    ]
    return cell.members, spaces, cell.handover, [pose.q for pose in cell.stations], cell.recipes


def test_both_forms_are_the_same_cell(tmp_path: Path) -> None:
    short, long = (read(tmp_path, text).cell("bay") for text in (SHORT, LONG))
    arm, mobile = short.spaces
    ways = {name: pose for name, pose in arm.targets.items() if name not in ("pickup_b",)}
    poses = tuple(replace(pose, name=name, title=NOTHING) for name, pose in ways.items())
    same = replace(arm, target_names=(), poses=poses)
    short = replace(short, spaces=(same, replace(mobile, poses=(mobile.home,))))
    assert of_targets(short) == of_targets(long)


def test_the_recipes_of_storage_run_in_a_cell_of_devices(tmp_path: Path) -> None:
    rig = Rig(read(tmp_path, LONG))
    for text in ("bay 0A 1", "bay palletizing", "bay 0B 0"):
        rig.submit(text)
    rig.wait(600, until=lambda: rig.plant.at_rest and not rig.plant.cells["bay"].queue)
    assert [change.state for change in rig.outcomes().values()] == [TaskState.DONE] * 3


def test_the_case_of_a_path_does_not_matter(tmp_path: Path) -> None:
    assert read(tmp_path, LONG.replace("by_path: {0A:", "by_path: {0a:")) == read(tmp_path, LONG)


def wrong(folder: Path, step: Callable[[Kit], Step]) -> str:
    """The sentence with which a recipe of the cell in LONG is refused."""
    run = Plant(read(folder, LONG), epoch=1, now=0.0).cells["bay"]
    with pytest.raises(RecipeError) as refused:
        step(Kit(run.context))
    return str(refused.value)


def test_a_tour_or_a_path_that_cannot_be_is_refused(tmp_path: Path) -> None:
    zoned = LONG.replace("name: hall\n", "name: hall\nzones: {rack: {poses: [bay station_0]}}\n")
    run = Plant(read(tmp_path, zoned), epoch=1, now=0.0).cells["bay"]
    with pytest.raises(
        RecipeError, match="a tour has to end outside all zones, and station_0 lies in zone rack"
    ):
        Kit(run.context).device("arm").tour("home", "station_0")
    assert "it has no stops" in wrong(tmp_path, lambda cell: cell.device("arm").tour())
    assert "no path '9Z'" in wrong(tmp_path, lambda cell: cell.device("mobile").follow("9Z"))
    assert "no group of targets 'shelf'" in wrong(tmp_path, lambda cell: cell.group("shelf"))
