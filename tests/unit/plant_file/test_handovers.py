"""Paths, handovers and pick-ups of a cell: the same in both forms, one pose for all exits or one for each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from arboleda.core.plant import Plant
from arboleda.model.errors import ConfigError
from arboleda.model.messages import TaskState
from arboleda.model.plant_model import Cell
from arboleda.model.sentence import NOTHING
from arboleda.plant_file import loader
from arboleda.recipes import Kit, RecipeError
from arboleda.recipes.handles import Step
from arboleda.testing import Rig
from arboleda.testing.storage_layout import StorageLayout

from ...plants import plant_text, read, rows

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


TEXT = plant_text(__file__, "config_pickups")
ONE = "    pickup: {deg: [45, 10], mm: 0}\n"
TWO = "    pickups:\n      A: {deg: [40, 5], mm: 0}\n      c: {deg: [50, 5], mm: 10, approach_mm: 5}\n"
B = "      B: {deg: [1, 1], mm: 0}\n"


def cell(tmp_path: Path, text: str) -> Cell:
    file = tmp_path / "p.yaml"
    file.write_text(TEXT + text, "utf-8")
    return loader.load(file).cells[0]


def taken_at(of: Cell) -> dict[str, str]:
    layout = StorageLayout(of)
    return {path.code: layout.pickup_of(path).name for path in layout.paths}


def test_one_pick_up_serves_all_exits(tmp_path: Path) -> None:
    read = cell(tmp_path, ONE)
    layout = StorageLayout(read)
    assert taken_at(read) == dict.fromkeys(("0A", "1B", "2C"), "pick-up")
    assert layout.pickups == (layout.pickup,)


def test_an_exit_with_a_pick_up_of_its_own_uses_that(tmp_path: Path) -> None:
    read = cell(tmp_path, ONE + TWO)
    layout = StorageLayout(read)
    assert taken_at(read) == {"0A": "pick-up A", "1B": "pick-up", "2C": "pick-up C"}
    assert [pose.name for pose in layout.space.poses] == [
        "home",
        "pick-up",
        "pick-up A",
        "pick-up C",
        "station 0",
    ]
    assert layout.pickup_of(layout.path("2C")).above is not None
    assert [read.pickup_over(node).name for node in (6, 7, 8, 3, None)] == [
        "pick-up A",
        "pick-up",
        "pick-up C",
        "pick-up",
        "pick-up",
    ]


def test_where_every_exit_is_named_no_other_pick_up_is_needed(tmp_path: Path) -> None:
    read = cell(tmp_path, TWO + B)
    assert taken_at(read) == {"0A": "pick-up A", "1B": "pick-up B", "2C": "pick-up C"}
    assert StorageLayout(read).palletizing.pick.name == "pick-up A"
    assert [pose.name for pose in StorageLayout(read).pickups] == ["pick-up A", "pick-up C", "pick-up B"]


def test_palletizing_and_zones_name_the_pick_up_of_an_exit(tmp_path: Path) -> None:
    more = "palletizing: {pick: Pickup c, place: station 0}\nzones: {z: {poses: [a pickup A]}}\n"
    read = cell(tmp_path, ONE + TWO + more)
    assert StorageLayout(read).palletizing.pick.name == "pick-up C"
    assert {pose.name for pose in StorageLayout(read).space.poses if pose.zones} == {"pick-up A"}
    assert StorageLayout(read).space.zones == {"z"}


MISTAKES = rows(__file__, "config_pickups")


@pytest.mark.parametrize(("text", "where", "why"), MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_is_named(tmp_path: Path, text: str, where: str, why: str) -> None:
    with pytest.raises(ConfigError) as refusal:
        cell(tmp_path, text)
    assert any(where in each and why in each for each in refusal.value.problems), refusal.value.problems
