"""Every mistake in a plant file is named with its line, its place and what is allowed."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader
from arboleda.testing.storage_layout import StorageLayout

from ...plants import plant_text

PLANT = plant_text(__file__, "config_errors")
ONE_CELL = plant_text(__file__, "config_errors_one_cell")
RACK = "stations: {columns_q1_deg: [0, 10, 20], rows_q2_deg: [0, 10, 20]}"

MISTAKES = {  # id: (text, put in its place, the sentence starts with, and has in it)
    "unknown key": ("timing:", "timming:", "3:1: the key", 'did you mean "timing"?'),
    "later key": ("    queue_limit", "    zones: []\n    queue_limit", "30:5: cells.sis_a", 'is not known'),
    "missing key": ("      model: scara\n", "", "13:7: cells.sis_a.arm", 'the key "model" is missing'),
    "plant name": ("name: small", "name: Small Plant", "1:7: name", "small letters"),
    "text for number": ("timeout_s: 12", "timeout_s: abc", "22:18: cells.sis_a.arm", 'number, is "abc"'),
    "quoted number": ("timeout_s: 12", "timeout_s: '12'", "22:18: ", "write 12 without quotes"),
    "leading zero": ("timeout_s: 12", "timeout_s: 012", "22:18: ", 'is "012"; write 12 without'),
    "clock for number": ("timeout_s: 12", "timeout_s: 12:30", "22:18: ", 'must be a number, is "12:30"'),
    "bool for number": ("timeout_s: 12", "timeout_s: true", "22:18: ", "must be a number, is true"),
    "no value": ("timeout_s: 12", "timeout_s:", "22:17: ", "must be a number, is empty"),
    "zero timeout": ("timeout_s: 12", "timeout_s: 0", "22:18: ", "must be more than 0, is 0"),
    "endless timeout": ("timeout_s: 12", "timeout_s: .inf", "22:18: ", "must be a finite number, is inf"),
    "overflowing timeout": ("timeout_s: 12", "timeout_s: 1e999", "22:18: ", "must be a finite number"),
    "timeout of years": ("timeout_s: 12", "timeout_s: 1e9", "22:18: ", "at most 86400, is 1000000000"),
    "negative dwell": ("dwell_s: 0.2", "dwell_s: -1", "3:19: timing.dwell_s", "at least 0, is -1"),
    "unknown time": ("dwell_s", "dwel_s", "3:10: timing: the key", 'did you mean "dwell_s"?'),
    "on for true": ("drive_to_start: false", "drive_to_start: on", "31:21: ", 'true or false, is "on"'),
    "go on without proof": (
        "    home: {deg: [0, 0, 0",
        "    on_absence: go_on\n    home: {deg: [0, 0, 0",
        "35:17: cells.sis_c.on_absence",
        "rm_sis_c has none",
    ),
    "half a task": ("queue_limit: 5", "queue_limit: 1.5", "30:18: ", "must be a whole number, is 1.5"),
    "no queue": ("queue_limit: 5", "queue_limit: 0", "30:18: ", "must be at least 1, is 0"),
    "mqtt version": ("3.1.1", "3.1", "2:15: mqtt_version", "must be 3.1.1 or 5, is 3.1"),
    "evidence": ("ids\n      limits", "id\n      limits", "18:17: ", 'ids, joints or state, is "id"'),
    "link": ("link: ros", "link: rso", "34:36: cells.sis_c.mobile.link", 'did you mean "ros"?'),
    "model": (
        "model: scara",
        "model: skara",
        "14:14: ",
        'scara or a file beside this one (models/my_arm.urdf), is "skara"; did you mean "scara"?',
    ),
    "robot name": ("name: ra1", "name: RA-1", "13:13: ", "letters, digits and single underscores"),
    "double underscore": ("name: ra1", "name: ra__1", "13:13: ", "single underscores"),
    "cell name": ("  sis_a:", "  Sis A:", "11:3: cells.Sis A", "a cell's name must be"),
    "same robot": ("name: ra3", "name: ra1", "33:17: ", '"ra1" is already that of cells.sis_a.arm.name'),
    "robot as cell": ("name: rm_sis_a", "name: sis_c", "24:13: ", '"sis_c" is already that of cells.sis_c'),
    "same mqtt": ("name: ra3,", "name: ra3, mqtt: ra_1,", "33:28: ", 'MQTT name "ra_1" is already that of'),
    "same twin": ("name: ra3,", "name: ra3, twin: r1,", "33:28: ", 'twin name "r1" is already that of'),
    "twin of another": ("twin: r1", "twin: rm_sis_a", "16:13: ", "already that of cells.sis_a.mobile"),
    "reserved name": ("name: ra3", "name: plant", "33:17: ", "taken by topics of the plant itself"),
    "pose too long": ("[45, 10]", "[45, 10, 3]", "29:19: ", "has 3 values; the scara has 2 turning"),
    "pose too short": ("[35, 10, 0, 0, 0, 0]", "[35]", "36:19: ", "the cr10a has 6 turning joints"),
    "no mm": ("[45, 10], mm: 0", "[45, 10]", "29:13: cells.sis_a.pickup", '"mm" is missing'),
    "mm on a cr10a": ("[0, 0, 0, 0, 0, 0]", "[0, 0, 0, 0, 0, 0], mm: 1", "35:41: ", "no sliding joint"),
    "outside narrowed limits": ("[45, 10]", "[95, 10]", "29:20: ", "95 deg is outside the limits of q1"),
    "outside model limits": ("[45, 10]", "[45, 136]", "29:24: ", "allowed: -135 deg to 135 deg"),
    "too deep": ("[45, 10], mm: 0", "[45, 10], mm: 100.1", "29:33: ", "allowed: 0 mm to 100 mm"),
    "shared station outside": ("[15, 10]", "[91, 10]", "8:13: stations.1.deg", "(cell sis_a)"),
    "approach above the top": ("approach_mm: 20", "approach_mm: 41", "7:42: ", "would lift q3 to -1 mm"),
    "approach of a cr10a": ("35, 10, 0, 0, 0, 0]", "35, 10, 0, 0, 0, 0], approach_mm: 5", "36:54: ", "cr10a"),
    "approach at home": ("[0, 0], mm: 0", "[0, 0], mm: 0, approach_mm: 5", "28:32: ", "is not known"),
    "wider limits": ("[-90, 90]", "[-151, 90]", "19:24: ", "within -150 deg to 150 deg"),
    "limits upside down": ("[-90, 90]", "[90, -90]", "19:24: ", "lower first"),
    "limits without 0": ("[-90, 90]", "[10, 90]", "19:24: ", "with 0 (homed) inside"),
    "limits of one number": ("[-90, 90]", "[90]", "19:24: ", "must have at least 2 values, has 1"),
    "limits in another unit": ("q1_deg: [-90, 90]", "q1_mm: [-90, 90]", "19:16: ", "known: q1_deg, q2_deg"),
    "faster than the model": ("q3_mm_s: 30", "q3_mm_s: 61", "20:25: ", "must be at most 60 mm/s"),
    "mobile too fast": ("grid: {pitch", "speed_mm_s: 300\n      grid: {pitch", "27:19: ", "at most 200 mm/s"),
    "tight tolerance": ("{deg: [1, 1], mm: 1}", "{deg: [1, 0.4], mm: 1}", "21:18: ", "q2 must have at least"),
    "station gap": ("  1: {deg", "  2: {deg", "8:3: stations.2", "without a gap"),
    "station word": ("  1: {deg", "  one: {deg", "8:3: stations.one", "is not a station here"),
    "rack too big": ("[0, 10, 20], rows", "[0, 5, 10, 20], rows", "37:15: ", "3 rows x 4 columns are more"),
    "rack outside": ("[0, 10, 20], rows", "[0, 999], rows", "37:36: ", "999 deg is outside"),
    "diagonal": ("[0, 3, 4, 7]", "[0, 4, 7]", "5:11: paths.0B[1]", "no neighbour of node 0"),
    "standing still": ("[0, 3, 4, 7]", "[0, 0, 3]", "5:11: ", "no neighbour"),
    "off the grid": ("[0, 3, 4, 7]", "[0, 3, 6, 9]", "5:17: paths.0B[3]", "0 to 8, is 9"),
    "no nodes": ("[0, 3, 4, 7]", "[]", "5:7: paths.0B", "at least 1 value, has 0"),
    "nodes as text": ("[0, 3, 4, 7]", "0347", "5:7: ", 'must be a list [a, b, ...], is "0347"'),
    "path code": ("  0B:", "  0-B:", "5:3: paths.0-B", "two letters or digits"),
    "path code of one": ("  0B:", "  B:", "5:3: paths.B", "two letters or digits"),
    "same path code": ("  0B: [0", "  0b: [0, 1]\n  0B: [0", "6:3: paths.0B", 'the same code as "0b"'),
    "unknown place": ("place: station 1", "place: station 2", "9:36: ", 'to "station 1", is "station 2"'),
    "pick is place": ("place: station 1", "place: pickup", "9:36: ", "must be another pose than pick"),
    "no stations": ("    stations: {", "    statoins: {", "37:5: ", 'did you mean "stations"?'),
    "stop word": ("link: ros", "stop: no, link: ros", "34:36: ", 'must be supported or none, is "no"'),
    "empty port": ("name: small", "name: small\ngroot2:", "2:8: groot2", "a whole number"),
    "no port": ("name: small", "name: small\ngroot2: 0", "2:9: groot2", "at least 1"),
    "no room for ports": ("name: small", "name: small\ngroot2: 65533", "2:9: groot2", "at most 65532"),
    "cells as list": ("cells:\n", "cells: [1]\ncellz:\n", "10:8: cells", "must be a mapping"),
}  # fmt: skip


def load(tmp_path: Path, text: str) -> PlantModel:
    file = tmp_path / "plant.yaml"
    file.write_text(text, "utf-8")
    return loader.load(file)


def problems(tmp_path: Path, text: str) -> list[str]:
    """The problems without the name of the file."""
    with pytest.raises(ConfigError) as refusal:
        load(tmp_path, text)
    prefix = f"{tmp_path / 'plant.yaml'}:"
    assert all(problem.startswith(prefix) for problem in refusal.value.problems)
    return [problem.removeprefix(prefix) for problem in refusal.value.problems]


def test_the_plant_of_these_tests_is_valid(tmp_path: Path) -> None:
    plant = load(tmp_path, PLANT)
    arm = StorageLayout(plant.cell("sis_a")).arm
    assert (arm.joints[2].speed, arm.timeout_s, arm.tolerance and arm.tolerance[2]) == (0.03, 12, 0.001)
    assert (plant.cell("sis_a").queue_limit, plant.cell("sis_a").drive_to_start) == (5, False)
    assert StorageLayout(plant.cell("sis_c")).arm.twin == StorageLayout(plant.cell("sis_c")).arm.mqtt == "ra3"


@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_is_named_with_its_line(tmp_path: Path, mistake: tuple[str, str, str, str]) -> None:
    old, new, start, words = mistake
    assert old in PLANT
    found = problems(tmp_path, PLANT.replace(old, new, 1))
    matching = [problem for problem in found if problem.startswith(start) and words in problem]
    assert len(matching) == 1, found


def test_all_mistakes_are_reported_at_once_in_the_order_of_the_file(tmp_path: Path) -> None:
    text = PLANT
    for old, new in (
        ("3.1.1", "4"),
        ("[0, 3, 4, 7]", "[0, 4]"),
        ("scara", "scarra"),
        ("queue_limit: 5", "queue_limit: x"),
    ):
        text = text.replace(old, new, 1)
    lines = [int(problem.split(":")[0]) for problem in problems(tmp_path, text)]
    assert lines == [2, 5, 14, 30]


def test_what_follows_a_misspelt_model_is_found_in_the_same_pass(tmp_path: Path) -> None:
    text = PLANT.replace("model: scara", "model: skara").replace("deg: [45, 10]", "deg: [45, 136]")
    text = text.replace("q3_mm_s: 30", "q3_mm_s: 61").replace(
        "{pitch_mm: 200}", "{pitch_mm: 200}\n      model: mobil"
    )
    found = problems(tmp_path, text)
    for words in ('is "skara"', "must be at most 60 mm/s", 'is "mobil"; did you mean "mobile"?', "135 deg"):
        assert any(words in problem for problem in found), words
    assert len(found) == 4


def test_a_model_that_nobody_can_guess_says_what_is_not_checked_yet(tmp_path: Path) -> None:
    (found,) = problems(tmp_path, PLANT.replace("model: scara", "model: puma"))
    assert found.endswith('is "puma"; what depends on the model is checked once it is right')


def test_a_cell_needs_stations_of_its_own_or_shared_ones(tmp_path: Path) -> None:
    shared, _, rest = PLANT.partition("stations:\n")
    text = shared + rest.split("\n", 2)[2]
    assert any('"stations" is missing, here and at the top' in each for each in problems(tmp_path, text))


def test_a_shared_section_that_no_cell_uses_is_refused(tmp_path: Path) -> None:
    text = PLANT.replace("    drive_to_start", f"    {RACK}\n    drive_to_start")
    assert problems(tmp_path, text) == [
        "7:3: stations: every cell has its own, so this section has no effect; delete it"
    ]


def test_a_rack_may_give_the_sliding_joint_and_an_approach(tmp_path: Path) -> None:
    rack = RACK.replace("}", ", mm: 50, approach_mm: 10}")
    stations = load(tmp_path, f"{ONE_CELL}{rack}\n").cell("sis_a").stations
    assert {pose.q[2] for pose in stations} == {0.05}
    assert [pose.above[2] for pose in stations if pose.above] == pytest.approx([0.04] * 9)


def test_without_palletizing_the_place_is_the_last_station(tmp_path: Path) -> None:
    cell = load(tmp_path, f"{ONE_CELL}stations: {{0: {{deg: [0, 10], mm: 0}}}}\n").cell("sis_a")
    layout = StorageLayout(cell)
    assert (layout.palletizing.pick, layout.palletizing.place) == (layout.pickup, cell.stations[0])


ROUND_TRIP = ONE_CELL.replace("[0, 3, 4, 7]", "[0, 3, 0]")
FAST = ROUND_TRIP.replace(
    "rm_sis_a, link: mqtt, evidence: ids", "rm_sis_a, link: mqtt, evidence: joints, grid: {pitch_mm: 39}"
)


def test_at_joints_a_round_trip_needs_edges_that_are_seen(tmp_path: Path) -> None:
    (found,) = problems(tmp_path, FAST + "    stations: {0: {deg: [1, 1], mm: 1}}\n")
    assert found.startswith("6:13: cells.sis_a.mobile: path 0B comes by its last node before its end")
    assert "a pitch_mm of 40 or more" in found


@pytest.mark.parametrize(
    ("old", "new"), [("39", "40"), ("evidence: joints", "evidence: ids"), ("[0, 3, 0]", "[0, 3, 4]")]
)
def test_elsewhere_edges_may_be_short(tmp_path: Path, old: str, new: str) -> None:
    load(tmp_path, FAST.replace(old, new) + "    stations: {0: {deg: [1, 1], mm: 1}}\n")


HASTY = ONE_CELL.replace("evidence: ids}", "evidence: joints, timeout_s: 0.4}", 1)
TIMES = "timing: {deadline_factor: 1, deadline_floor_s: 0.1}\n"
STATIONS = "    stations: {0: {deg: [1, 1], mm: 1}}\n"


def test_a_robot_is_given_the_time_in_which_an_arrival_shows(tmp_path: Path) -> None:
    (found,) = problems(tmp_path, TIMES + HASTY + STATIONS)
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
    load(tmp_path, (times + HASTY + STATIONS).replace(old, new))


def test_at_joints_a_drive_is_given_the_time_for_a_node_that_is_told_long_after_its_stop(
    tmp_path: Path,
) -> None:
    quick = ONE_CELL.replace("evidence: ids}\n    home:", "evidence: joints, timeout_s: 0.5}\n    home:")
    (found,) = problems(tmp_path, TIMES.replace("0.1", "0.5") + quick + STATIONS)
    assert "cells.sis_a.mobile: a move may take only 0.5 s longer than computed" in found
    assert "an arrival may show 0.8 s later: a deadline_floor_s of 0.8 or more" in found
    load(tmp_path, TIMES.replace("0.1", "0.8") + quick + STATIONS)


def test_a_drive_over_a_path_may_begin_on_any_node_of_the_grid(tmp_path: Path) -> None:
    """Eight edges of 1 s for a path of four nodes; 6 s are enough without the way to its start."""
    mobile = "evidence: joints, speed_mm_s: 100, timeout_s: 6, grid: {pitch_mm: 100}}\n    home:"
    slow = ONE_CELL.replace("evidence: ids}\n    home:", mobile)
    (found,) = problems(tmp_path, TIMES + slow + STATIONS)
    assert "cells.sis_a.mobile: a move may take only 0.1 s longer than computed (timeout_s 6," in found
    load(tmp_path, TIMES + slow + STATIONS + "    drive_to_start: false\n")


def test_at_state_a_move_of_no_length_is_given_time_for_a_word(tmp_path: Path) -> None:
    silent = ONE_CELL.replace("evidence: ids", "evidence: state") + STATIONS
    of_arm, of_mobile = problems(tmp_path, "timing: {stop_timeout_s: 0.2}\n" + silent)
    rule = "1:26: timing.stop_timeout_s: must be at least 0.3 for {}, which has evidence: state"
    assert of_arm.startswith(rule.format("ra1")) and of_mobile.startswith(rule.format("rm_sis_a"))
    load(tmp_path, "timing: {stop_timeout_s: 0.3}\n" + silent)
    load(tmp_path, "timing: {stop_timeout_s: 0.2}\n" + ONE_CELL + STATIONS)
