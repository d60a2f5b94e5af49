"""A model of one's own that is wrong: one sentence for each mistake, with its file and line."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.plant_file import loader

from ...plants import changed, rows
from .own_arms import GANTRY, ONE, TENDER, joint, link, robot, swing, tender, written

TWO_TIPS = robot(*map(link, "abc"), joint("left", "a b"), joint("right", "a c"))
FINGERS = robot(
    *map(link, "abcd"),
    joint("swing", "a b"),
    joint("left", "b c"),
    joint("right", "b d", more='<mimic joint="left"/>'),
).replace('<joint name="right"', '\n<joint name="right"')
WRONG = {  # the file, then its line and a part of what is said
    "not XML": ("<robot", 1, "this is not XML: "),
    "entities": (
        '<!DOCTYPE r [<!ENTITY a "b">]>\n' + ONE,
        1,
        "a document type (<!DOCTYPE ...>) is not allowed",
    ),
    "nested": ("<a>" * 40 + "</a>" * 40, 1, "nested deeper than 30 levels"),
    "another root": ("<sdf/>", 1, "a URDF begins with <robot>, not <sdf>"),
    "no links": ("<robot/>", 1, "it has no links"),
    "no joints": (robot(link("a")), 1, "no joint moves; an arm has a revolute, continuous or prismatic one"),
    "nothing moves": (robot(link("a"), link("b"), joint("j", "a b", "fixed", limit="")), 1, "no joint moves"),
    "two tips": (TWO_TIPS, 6, "two ends that move, b and c; say with tip_link which one is the arm's tool"),
    "two fingers": (FINGERS, 9, "one is the arm's tool; if they are fingers, write tip_link: b"),
    "two ends": (
        ONE.replace("</robot>", link("x") + joint("k", "beam x", "fixed") + "</robot>").replace(
            "</robot>", link("y") + joint("l", "beam y", "fixed") + "</robot>"
        ),
        3,
        "the link beam has the ends x, y; say with tip_link which is the tool",
    ),
    "two roots": (robot(*map(link, "abc"), joint("j", "b c")), 3, "begins with several links, a and b"),
    "a circle": (
        robot(*map(link, "abc"), joint("i", "b c"), joint("j", "c b")),
        6,
        "the joints go round in a circle, from b back to it",
    ),
    "two parents": (
        robot(*map(link, "abc"), joint("i", "a c"), joint("j", "b c")),
        6,
        "hangs on two joints, i and j",
    ),
    "a missing link": (robot(link("post"), joint("j", "post beam")), 3, 'a link of this file, is "beam"'),
    "an unnamed link": (robot("<link/>\n", link("b")), 2, "this link has no name"),
    "mimic": (
        robot(
            *map(link, "abcd"),
            joint("swing", "a b"),
            joint("level", "b c", more='\n<mimic joint="swing"/>'),
            joint("turn", "c d"),
        ),
        8,
        "the joint level has <mimic>: it follows another joint",
    ),
    "no limit": (
        robot(link("post"), link("beam"), joint("j", "post beam", limit="")),
        4,
        "the joint j needs <limit> with lower and upper",
    ),
    "too many links": (
        robot(*(link(f"l{n}") for n in range(301))),
        1,
        "it has 301 links; at most 300 are taken",
    ),
    **{
        name: (changed(ONE, (old, new)), *said) for name, (old, new, *said) in rows(__file__, "urdfs").items()
    },
}


@pytest.mark.parametrize(("urdf", "line", "words"), WRONG.values(), ids=WRONG)
def test_a_mistake_in_a_urdf_is_one_sentence_with_its_line(
    tmp_path: Path, urdf: str, line: int, words: str
) -> None:
    with pytest.raises(ConfigError) as refusal:
        swing(tmp_path, urdf)
    (said,) = refusal.value.problems
    assert said.startswith(f"{tmp_path / 'one.urdf'}:{line}:") and words in said


def test_every_mistake_of_a_urdf_is_said_at_once_and_those_of_the_plant_file_first(tmp_path: Path) -> None:
    urdf = ONE.replace("revolute", "planar").replace("0 0 0.3", "0 0")
    with pytest.raises(ConfigError) as refusal:
        swing(tmp_path, urdf, more=", timeout_s: soon")
    files = [problem.rpartition("/")[2].split(":")[0] for problem in refusal.value.problems]
    assert files == ["plant.yaml", "one.urdf", "one.urdf"]


def test_a_model_of_two_cells_is_said_once(tmp_path: Path) -> None:
    (tmp_path / "one.urdf").write_text(ONE.replace("revolute", "planar"))
    file = written(tmp_path, "one.urdf", ("{deg: [0]}", "{deg: [30]}", "{0: {deg: [-30]}}"))
    text = file.read_text()
    file.write_text(
        text
        + text.partition("cells:\n")[2].replace("a:", "b:", 1).replace("ra,", "rb,").replace("ma,", "mb,")
    )
    with pytest.raises(ConfigError) as refusal:
        loader.load(file)
    assert len(refusal.value.problems) == 1


def test_what_is_no_file_to_read_is_said_where_it_is_named(tmp_path: Path) -> None:
    (tmp_path / "folder.urdf").mkdir()
    os.mkfifo(tmp_path / "pipe.urdf")
    with (tmp_path / "huge.urdf").open("wb") as huge:
        huge.truncate(100 * 1024 * 1024)
    (tmp_path / "binary.urdf").write_bytes(bytes(range(256)))
    said = {
        "nowhere.urdf": "there is no such file",
        "folder.urdf": "is a directory; a file is wanted",
        "pipe.urdf": "is not a regular file",
        "huge.urdf": "is larger than 1024 KiB",
        "mine.urdf.xacro": "type `xacro mine.urdf.xacro > mine.urdf` and name that",
        "models/mine.stl": "must be a file that ends in .urdf, .yaml or .yml",
    }
    for name, words in said.items():
        with pytest.raises(ConfigError) as refusal:
            swing(tmp_path, model=name)
        (problem,) = refusal.value.problems
        assert problem.startswith(f"{tmp_path / 'plant.yaml'}:5:28: cells.a.arm.model: ") and words in problem
    with pytest.raises(ConfigError, match=r"binary.urdf:1:1: this is not XML"):
        swing(tmp_path, model="binary.urdf")


def test_a_name_with_letters_that_a_terminal_obeys_is_shown_without_them(tmp_path: Path) -> None:
    with pytest.raises(ConfigError) as refusal:
        swing(tmp_path, model='"\\e[2J.urdf"')
    assert refusal.value.problems[0].endswith("\\x1b[2J.urdf: there is no such file")


def test_an_encoding_that_nobody_knows_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"one.urdf:1:\d+: this is not XML: "):
        swing(tmp_path, '<?xml version="1.0" encoding="klingon"?>' + ONE)


IN_THE_PLANT = rows(__file__, "models_in_a_plant")


@pytest.mark.parametrize(("model", "words"), IN_THE_PLANT.values(), ids=IN_THE_PLANT)
def test_a_mistake_in_what_is_said_of_a_model_is_named(tmp_path: Path, model: str, words: str) -> None:
    (tmp_path / "idle.urdf").write_text(ONE.replace('velocity="2"', 'velocity="0"'))
    (tmp_path / "wide.urdf").write_text(ONE.replace('="-1"', '="-10"').replace('="1"', '="10"'))
    with pytest.raises(ConfigError) as refusal:
        swing(tmp_path, model=model)
    (said,) = refusal.value.problems
    assert said.startswith(f"{tmp_path / 'plant.yaml'}:5:") and words in said


POSES = {  # poses of the gantry, and what is said of them
    "too few": ("{mm: [100, 200]}", "has 2 values; the gantry.urdf has 3 sliding joints"),
    "one number": ("{mm: 100}", "must be a list"),
    "no millimetres": ("{approach_mm: 3}", 'the key "mm" is missing: the gantry.urdf has 3 sliding joints'),
    "degrees": ("{deg: [1], mm: [0, 0, 0]}", "has 1 value; the gantry.urdf has no turning joint"),
    "beyond the limits": (
        "{mm: [0, 900, 0]}",
        "mm[1]: 900 mm is outside the limits of q2 (across); allowed: 0 mm to 500 mm",
    ),
    "too high": ("{mm: [0, 0, 190], approach_mm: 20}", "would lift q3 to 210 mm; allowed: -300 mm to 200 mm"),
}


@pytest.mark.parametrize(("pose", "words"), POSES.values(), ids=POSES)
def test_a_pose_of_sliding_joints_is_held_against_them(tmp_path: Path, pose: str, words: str) -> None:
    (tmp_path / "gantry.urdf").write_text(GANTRY)
    file = written(tmp_path, "gantry.urdf", ("{mm: [0, 0, 0]}", pose, "{0: {mm: [1, 1, 1]}}"))
    with pytest.raises(ConfigError) as refusal:
        loader.load(file)
    (said,) = refusal.value.problems
    assert said.startswith(f"{file}:8:") and words in said


def test_a_rack_by_rule_needs_two_joints_that_turn(tmp_path: Path) -> None:
    (tmp_path / "gantry.urdf").write_text(GANTRY)
    rack = "{columns_q1_deg: [0], rows_q2_deg: [0]}"
    file = written(tmp_path, "gantry.urdf", ("{mm: [0, 0, 0]}", "{mm: [1, 1, 1]}", rack))
    with pytest.raises(ConfigError, match="a rack by rule needs q1 and q2 that turn"):
        loader.load(file)


def test_more_joints_than_a_message_holds_are_refused(tmp_path: Path) -> None:
    names = [f"l{number}" for number in range(14)]
    joints = [joint(f"j{n}", f"l{n} l{n + 1}") for n in range(13)]
    with pytest.raises(ConfigError, match="has 13 joints that move, at most 12"):
        swing(tmp_path, robot(*map(link, names), *joints))


def test_a_limit_may_be_narrowed_and_never_widened(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"within -170.168 deg to 170.168 deg \(the model\)"):
        tender(tmp_path, more=", limits: {q1_deg: [-180, 90]}")
    with pytest.raises(ConfigError, match=r"must be at most 148.969 deg/s, the speed of the model"):
        tender(tmp_path, more=", speeds: {q1_deg_s: 200}")


YAML = """\
joints:
- {name: j, type: revolute, limits_deg: [-9, 9], speed_deg_s: 9, acceleration_deg_s2: 9, step_deg: 1}
"""
WRONG_YAML = {
    "empty": ("joints: []\n", 1, "an arm has one joint at least"),
    "no joints": ("model: mine\n", 1, 'the key "joints" is missing'),
    "0 outside": (YAML.replace("[-9, 9]", "[1, 9]"), 2, "must be lower, then upper, with 0 inside"),
    "a misspelt key": (YAML.replace("speed_deg_s", "sped_deg_s"), 2, 'did you mean "speed_deg_s"?'),
    "a name twice": (YAML + YAML.partition("\n")[2], 3, "two joints have the name j"),
    "a mobile": ("kind: mobile\n" + YAML, 1, 'must be arm, is "mobile"'),
    "continuous with ends": (YAML.replace("revolute", "continuous"), 2, "a continuous joint has no ends"),
}


@pytest.mark.parametrize(("text", "line", "words"), WRONG_YAML.values(), ids=WRONG_YAML)
def test_a_mistake_in_a_yaml_model_has_its_line(tmp_path: Path, text: str, line: int, words: str) -> None:
    (tmp_path / "one.yaml").write_text(text)
    with pytest.raises(ConfigError) as refusal:
        swing(tmp_path, model="one.yaml")
    assert any(
        said.startswith(f"{tmp_path / 'one.yaml'}:{line}:") and words in said
        for said in refusal.value.problems
    )


def test_a_yaml_has_no_links_to_name(tmp_path: Path) -> None:
    (tmp_path / "one.yaml").write_text(YAML)
    with pytest.raises(ConfigError, match=r"model.tip_link: only a URDF has links; delete it"):
        swing(tmp_path, model="{file: one.yaml, tip_link: x}")


def test_a_content_that_lies_nowhere_has_no_models_beside_it() -> None:
    plant = Path(TENDER.parents[2] / "plants/own_arm.yaml").read_bytes()
    with pytest.raises(ConfigError, match="this plant file lies in no folder"):
        loader.parse("plant.yaml", plant)
