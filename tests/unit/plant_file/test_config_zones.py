"""Shared zones, retry, piece check and triggers in a plant file."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

import pytest

from arboleda.model.plant_model import Cell, Crossing, Pose, Retry, Timing
from arboleda.plant_file import loader
from arboleda.testing.storage_layout import StorageLayout

from ...plants import changed, read, refused, rows

DOCS = Path(__file__).parents[3] / "docs" / "how-to" / "plant-file.md"
PLANT = files("arboleda").joinpath("plants/plant.yaml").read_text("utf-8")
ZONES = """\
zones:
  centre:
    poses: [sis_a pickup, sis_b station 4]
    moves: [[sis_a home, sis_a station 2]]
  rack:
    poses: [sis_b station 4]
    moves:
      - [SIS_A  station 2, sis_a home]
      - [sis_b pickup, sis_b home]
"""
MISTAKES = rows(__file__, "zones")
KEYS = rows(__file__, "keys_of_cells")


def poses(cell: Cell) -> list[Pose]:
    layout = StorageLayout(cell)
    return [layout.home, layout.pickup, *cell.stations, layout.palletizing.pick, layout.palletizing.place]


def test_the_shipped_plant_shares_nothing_and_has_the_defaults() -> None:
    plant = loader.load()
    assert (plant.zones, plant.timing.piece_wait_s, plant.timing.piece_debounce_s) == ((), 2.0, 0.1)
    for cell in plant.cells:
        layout = StorageLayout(cell)
        assert not any(pose.zones for pose in poses(cell))
        assert (layout.space.crossings, cell.zone_wait_s, cell.retry, cell.piece_check) == (
            (),
            30.0,
            Retry(),
            "auto",
        )
        assert (layout.arm.piece_on_change, layout.arm.queue_triggers) == (False, True)
        assert (layout.arm.home_at_start, layout.mobile.home_at_start) == (False, False)


def test_poses_lie_in_their_zones(tmp_path: Path) -> None:
    plant = read(tmp_path, ZONES + PLANT)
    assert plant.zones == ("centre", "rack")
    inside = {
        (cell.name, pose.name): pose.zones for cell in plant.cells for pose in poses(cell) if pose.zones
    }
    assert inside == {("sis_a", "pick-up"): {"centre"}, ("sis_b", "station 4"): {"centre", "rack"}}


def test_palletizing_knows_the_zones_of_its_poses(tmp_path: Path) -> None:
    cell = read(tmp_path, ZONES + PLANT).cell("sis_a")
    layout = StorageLayout(cell)
    assert layout.palletizing.pick == layout.pickup


def test_a_crossing_names_every_zone_between_its_ends(tmp_path: Path) -> None:
    plant = read(tmp_path, ZONES + PLANT)
    both, rack = frozenset({"centre", "rack"}), frozenset({"rack"})
    assert StorageLayout(plant.cell("sis_a")).space.crossings == (
        Crossing(a="home", b="station 2", zones=both),
    )
    assert StorageLayout(plant.cell("sis_b")).space.crossings == (
        Crossing(a="home", b="pick-up", zones=rack),
    )
    assert StorageLayout(plant.cell("sis_c")).space.crossings == ()


def test_the_zones_of_the_page_are_some(tmp_path: Path) -> None:
    example = next(part for part in DOCS.read_text("utf-8").split("```") if part.startswith("yaml\nzones:"))
    assert read(tmp_path, example.removeprefix("yaml\n") + PLANT).zones == ("centre",)


@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_in_a_zone_is_named_with_its_line(
    tmp_path: Path, mistake: tuple[str, str, str, str]
) -> None:
    old, new, start, words = mistake
    found = refused(tmp_path, changed(ZONES, (old, new)) + PLANT)
    assert [start in problem and words in problem for problem in found] == [True], found


@pytest.mark.parametrize("section", ["zones:\n", "zones: {}\n", "zones: [centre]\n"])
def test_a_section_without_zones_is_refused(tmp_path: Path, section: str) -> None:
    assert len(refused(tmp_path, section + PLANT)) == 1


def test_a_cell_that_cannot_be_read_says_so_once(tmp_path: Path) -> None:
    found = refused(tmp_path, ZONES + PLANT.replace("deg: [45, 10]", "deg: [45]"))
    assert len(found) == 1 and "turning joints" in found[0]


def test_mistakes_in_zones_and_in_cells_are_reported_together(tmp_path: Path) -> None:
    text = ZONES.replace("sis_a pickup", "sis_c home") + PLANT.replace("deg: [35, 10]", "deg: [35]")
    assert ["lies in zone" in problem for problem in refused(tmp_path, text)] == [True, False]


def test_what_a_cell_and_its_robots_do_in_trouble_can_be_chosen(tmp_path: Path) -> None:
    of_cell = ("retry: {times: 2, backoff_s: 0.5}", "piece_check: true", "zone_wait_s: 5", "pickup:")
    of_arm = ("piece_on_change: true", "trigger_when_busy: refuse", "home_at_start: true", "twin:")
    text = PLANT.replace("    pickup:", "".join(f"    {key}\n" for key in of_cell).rstrip(), 1)
    text = text.replace("      twin:", "".join(f"      {key}\n" for key in of_arm).rstrip(), 1)
    cell = read(tmp_path, text).cell("sis_a")
    layout = StorageLayout(cell)
    assert (cell.retry, cell.piece_check, cell.zone_wait_s) == (Retry(times=2, backoff_s=0.5), True, 5)
    assert (layout.arm.piece_on_change, layout.arm.queue_triggers, layout.arm.home_at_start) == (
        True,
        False,
        True,
    )


@pytest.mark.parametrize(("word", "check"), [("auto", "auto"), ("true", True), ("false", False)])
def test_whether_pieces_are_checked_can_be_chosen(tmp_path: Path, word: str, check: object) -> None:
    text = PLANT.replace("    pickup:", f"    piece_check: {word}\n    pickup:", 1)
    assert read(tmp_path, text).cell("sis_a").piece_check == check


def test_the_times_of_a_piece_check_can_be_chosen(tmp_path: Path) -> None:
    plant = read(tmp_path, "timing: {piece_wait_s: 3, piece_debounce_s: 0}\n" + PLANT)
    assert plant.timing == Timing(piece_wait_s=3, piece_debounce_s=0)


@pytest.mark.parametrize("mistake", KEYS.values(), ids=KEYS)
def test_a_mistake_in_a_key_of_a_cell_is_named(tmp_path: Path, mistake: tuple[str, str, str]) -> None:
    old, new, words = mistake
    found = refused(tmp_path, changed(PLANT, (old, new)))
    assert [words in problem for problem in found] == [True], found


def alike(tmp_path: Path, zones: str) -> list[str]:
    """What is refused of an arm whose stations 0 and 1 are just within twice its tolerance."""
    return refused(tmp_path, TOLERANT.format(tolerance=WIDE) + zones)


@pytest.mark.parametrize(
    ("zones", "sentence"),
    [
        ("{poses: [a station 1]}", "station 1 lies in the zone and station 0 does not; in every joint they"),
        ("{moves: [[a station 1, a station 0]]}", "a move between station 0 and station 1 crosses the zone"),
        ("{poses: [a station 2]}", "station 2 looks like the reference (all joints 0) to the arm; homing"),
    ],
)
def test_a_zone_that_the_tolerance_blurs_is_refused(tmp_path: Path, zones: str, sentence: str) -> None:
    found = alike(tmp_path, f"zones:\n  z: {zones}\n")
    assert [f"cell a: {sentence}" in problem for problem in found] == [True], found


@pytest.mark.parametrize(
    "zones", ["{poses: [a station 1, a station 0]}", "{moves: [[a station 1, a pickup]]}"]
)
def test_poses_that_look_the_same_and_lie_in_the_same_zones_are_taken(tmp_path: Path, zones: str) -> None:
    cell = read(tmp_path, TOLERANT.format(tolerance=WIDE) + f"zones:\n  z: {zones}\n").cell("a")
    layout = StorageLayout(cell)
    named = {"station 0", "station 1"}
    assert {pose.name for pose in layout.space.poses if pose.zones} in (set(), named)
    assert {each.a for each in layout.space.crossings} | {
        each.b for each in layout.space.crossings
    } <= named | {"pick-up"}


def test_a_pose_in_a_zone_beyond_twice_the_tolerance_is_taken(tmp_path: Path) -> None:
    zones = "zones:\n  z: {poses: [a station 1]}\n"
    assert read(tmp_path, TOLERANT.format(tolerance="{deg: [3, 2.24], mm: 5}") + zones).zones == ("z",)


def test_the_point_above_a_pose_counts_as_the_pose(tmp_path: Path) -> None:
    text = TOLERANT.format(tolerance=WIDE).replace(
        "1: {deg: [45, 49.5], mm: 60}", "1: {deg: [45, 49.5], mm: 90, approach_mm: 30}"
    )
    (found,) = refused(tmp_path, text + "zones:\n  z: {poses: [a station 1]}\n")
    assert "station 1 lies in the zone and station 0 does not" in found


WIDE = "{deg: [3, 2.26], mm: 5}"
TOLERANT = """\
name: tolerant
cells:
  a:
    arm: {{name: arm, model: scara, link: mqtt, evidence: ids, tolerance: {tolerance}}}
    mobile: {{name: mobile, link: mqtt, evidence: ids}}
    home: {{deg: [90, 0], mm: 0}}
    pickup: {{deg: [-90, 0], mm: 50}}
    paths: {{0A: [0]}}
    stations:
      0: {{deg: [45, 45], mm: 60}}
      1: {{deg: [45, 49.5], mm: 60}}
      2: {{deg: [1, 1], mm: 1}}
      3: {{deg: [-40, -40], mm: 60}}
"""
