"""Every mistake in a plant file is named with its line, its place and what is allowed."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.testing.storage_layout import StorageLayout

from ...plants import plant_text, read, refused

PLANT = plant_text(__file__, "config_errors")
ONE_CELL = plant_text(__file__, "config_errors_one_cell")
RACK = "stations: {columns_q1_deg: [0, 10, 20], rows_q2_deg: [0, 10, 20]}"


def test_the_plant_of_these_tests_is_valid(tmp_path: Path) -> None:
    plant = read(tmp_path, PLANT)
    arm = StorageLayout(plant.cell("sis_a")).arm
    assert (arm.joints[2].speed, arm.timeout_s, arm.tolerance and arm.tolerance[2]) == (0.03, 12, 0.001)
    assert (plant.cell("sis_a").queue_limit, plant.cell("sis_a").drive_to_start) == (5, False)
    assert StorageLayout(plant.cell("sis_c")).arm.twin == StorageLayout(plant.cell("sis_c")).arm.mqtt == "ra3"


def test_all_mistakes_are_reported_at_once_in_the_order_of_the_file(tmp_path: Path) -> None:
    text = PLANT
    for old, new in (
        ("3.1.1", "4"),
        ("[0, 3, 4, 7]", "[0, 4]"),
        ("scara", "scarra"),
        ("queue_limit: 5", "queue_limit: x"),
    ):
        text = text.replace(old, new, 1)
    lines = [int(problem.split(":")[0]) for problem in refused(tmp_path, text)]
    assert lines == [2, 5, 14, 30]


def test_what_follows_a_misspelt_model_is_found_in_the_same_pass(tmp_path: Path) -> None:
    text = PLANT.replace("model: scara", "model: skara").replace("deg: [45, 10]", "deg: [45, 136]")
    text = text.replace("q3_mm_s: 30", "q3_mm_s: 61").replace(
        "{pitch_mm: 200}", "{pitch_mm: 200}\n      model: mobil"
    )
    found = refused(tmp_path, text)
    for words in ('is "skara"', "must be at most 60 mm/s", 'is "mobil"; did you mean "mobile"?', "135 deg"):
        assert any(words in problem for problem in found), words
    assert len(found) == 4


def test_a_model_that_nobody_can_guess_says_what_is_not_checked_yet(tmp_path: Path) -> None:
    (found,) = refused(tmp_path, PLANT.replace("model: scara", "model: puma"))
    assert found.endswith('is "puma"; what depends on the model is checked once it is right')


def test_a_cell_needs_stations_of_its_own_or_shared_ones(tmp_path: Path) -> None:
    shared, _, rest = PLANT.partition("stations:\n")
    text = shared + rest.split("\n", 2)[2]
    assert any('"stations" is missing, here and at the top' in each for each in refused(tmp_path, text))


def test_a_shared_section_that_no_cell_uses_is_refused(tmp_path: Path) -> None:
    text = PLANT.replace("    drive_to_start", f"    {RACK}\n    drive_to_start")
    assert refused(tmp_path, text) == [
        "7:3: stations: every cell has its own, so this section has no effect; delete it"
    ]


def test_a_rack_may_give_the_sliding_joint_and_an_approach(tmp_path: Path) -> None:
    rack = RACK.replace("}", ", mm: 50, approach_mm: 10}")
    stations = read(tmp_path, f"{ONE_CELL}{rack}\n").cell("sis_a").stations
    assert {pose.q[2] for pose in stations} == {0.05}
    assert [pose.above[2] for pose in stations if pose.above] == pytest.approx([0.04] * 9)


def test_without_palletizing_the_place_is_the_last_station(tmp_path: Path) -> None:
    cell = read(tmp_path, f"{ONE_CELL}stations: {{0: {{deg: [0, 10], mm: 0}}}}\n").cell("sis_a")
    layout = StorageLayout(cell)
    assert (layout.palletizing.pick, layout.palletizing.place) == (layout.pickup, cell.stations[0])


ROUND_TRIP = ONE_CELL.replace("[0, 3, 4, 7]", "[0, 3, 0]")
FAST = ROUND_TRIP.replace(
    "rm_sis_a, link: mqtt, evidence: ids", "rm_sis_a, link: mqtt, evidence: joints, grid: {pitch_mm: 39}"
)


def test_at_joints_a_round_trip_needs_edges_that_are_seen(tmp_path: Path) -> None:
    (found,) = refused(tmp_path, FAST + "    stations: {0: {deg: [1, 1], mm: 1}}\n")
    assert found.startswith("6:13: cells.sis_a.mobile: path 0B comes by its last node before its end")
    assert "a pitch_mm of 40 or more" in found


@pytest.mark.parametrize(
    ("old", "new"), [("39", "40"), ("evidence: joints", "evidence: ids"), ("[0, 3, 0]", "[0, 3, 4]")]
)
def test_elsewhere_edges_may_be_short(tmp_path: Path, old: str, new: str) -> None:
    read(tmp_path, FAST.replace(old, new) + "    stations: {0: {deg: [1, 1], mm: 1}}\n")


HASTY = ONE_CELL.replace("evidence: ids}", "evidence: joints, timeout_s: 0.4}", 1)
TIMES = "timing: {deadline_factor: 1, deadline_floor_s: 0.1}\n"
STATIONS = "    stations: {0: {deg: [1, 1], mm: 1}}\n"


def test_a_robot_is_given_the_time_in_which_an_arrival_shows(tmp_path: Path) -> None:
    (found,) = refused(tmp_path, TIMES + HASTY + STATIONS)
    assert ": cells.sis_a.arm: a move may take only 0.1 s longer than computed (timeout_s 0.4," in found
    assert (
        "with evidence: joints, an arrival may show 0.5 s later: a deadline_floor_s of 0.5 or more" in found
    )


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("floor_s: 0.1", "floor_s: 0.5"),
        ("evidence: joints", "evidence: ids"),
        ("timeout_s: 0.4", "timeout_s: 10"),  # which is more than the longest move takes
        ("timeout_s: 0.4", "timeout_s: 0.7"),
    ],
)
def test_what_gives_a_robot_that_time_is_taken(tmp_path: Path, old: str, new: str) -> None:
    factor = "3" if new.endswith("0.7") else "1"
    times = TIMES.replace("factor: 1", f"factor: {factor}")
    read(tmp_path, (times + HASTY + STATIONS).replace(old, new))


def test_at_joints_a_drive_is_given_the_time_for_a_node_that_is_told_long_after_its_stop(
    tmp_path: Path,
) -> None:
    quick = ONE_CELL.replace("evidence: ids}\n    home:", "evidence: joints, timeout_s: 0.5}\n    home:")
    (found,) = refused(tmp_path, TIMES.replace("0.1", "0.5") + quick + STATIONS)
    assert "cells.sis_a.mobile: a move may take only 0.5 s longer than computed" in found
    assert "an arrival may show 0.8 s later: a deadline_floor_s of 0.8 or more" in found
    read(tmp_path, TIMES.replace("0.1", "0.8") + quick + STATIONS)


def test_a_drive_over_a_path_may_begin_on_any_node_of_the_grid(tmp_path: Path) -> None:
    """Eight edges of 1 s for a path of four nodes; 6 s are enough without the way to its start."""
    mobile = "evidence: joints, speed_mm_s: 100, timeout_s: 6, grid: {pitch_mm: 100}}\n    home:"
    slow = ONE_CELL.replace("evidence: ids}\n    home:", mobile)
    (found,) = refused(tmp_path, TIMES + slow + STATIONS)
    assert "cells.sis_a.mobile: a move may take only 0.1 s longer than computed (timeout_s 6," in found
    read(tmp_path, TIMES + slow + STATIONS + "    drive_to_start: false\n")


def test_at_state_a_move_of_no_length_is_given_time_for_a_word(tmp_path: Path) -> None:
    silent = ONE_CELL.replace("evidence: ids", "evidence: state") + STATIONS
    of_arm, of_mobile = refused(tmp_path, "timing: {stop_timeout_s: 0.2}\n" + silent)
    rule = "1:26: timing.stop_timeout_s: must be at least 0.3 for {}, which has evidence: state"
    assert of_arm.startswith(rule.format("ra1")) and of_mobile.startswith(rule.format("rm_sis_a"))
    read(tmp_path, "timing: {stop_timeout_s: 0.3}\n" + silent)
    read(tmp_path, "timing: {stop_timeout_s: 0.2}\n" + ONE_CELL + STATIONS)
