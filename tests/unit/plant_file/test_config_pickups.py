"""`pickup` and `pickups` of a cell: one pose for all exits, poses of single exits, or both."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import Cell
from arboleda.plant_file import loader
from arboleda.testing.storage_layout import StorageLayout

from ...plants import plant_text, rows

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
