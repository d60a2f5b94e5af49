"""`arboleda urdf`: a robot of the plant on standard output, or one sentence."""

from __future__ import annotations

import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli, main
from arboleda.model.errors import ConfigError, StartError
from arboleda.plant_file import loader
from arboleda.plant_file.urdf import robot_urdf
from arboleda.testing import shipped
from arboleda_description import urdf as drawings

EXAMPLES = Path(__file__).parents[3] / "examples/plants"


@pytest.mark.parametrize(
    ("robot", "root"), [("ra1", "r1_base_link"), ("ra3", "r3_base_link"), ("rm_sis_b", "rm_sis_b_grid_link")]
)
def test_a_robot_is_printed_with_the_names_it_has_in_the_plant(robot: str, root: str) -> None:
    printed = CliRunner().invoke(cli, ["urdf", robot])
    assert printed.exit_code == 0
    drawn = ElementTree.fromstring(printed.output)
    children = {joint.find("child").get("link") for joint in drawn.iter("joint")}
    assert {link.get("name") for link in drawn.findall("link")} - children == {root}


def test_every_robot_of_every_plant_can_be_drawn() -> None:
    for plant in (shipped(), *map(loader.load, sorted(EXAMPLES.glob("*.yaml")))):
        drawn = [name for name, robot in plant.robots.items() if robot.drawn() is not None]
        assert drawn
        for robot in drawn:
            assert robot_urdf(plant, robot).startswith("<?xml")


def test_a_plant_file_is_asked_for_its_robots(tmp_path: Path) -> None:
    file = tmp_path / "plant.yaml"
    file.write_text((EXAMPLES / "joints.yaml").read_text().replace("twin: r1", "twin: left"))
    printed = CliRunner().invoke(cli, ["urdf", "ra1", "--plant", str(file)])
    assert printed.exit_code == 0 and 'joint name="left_brazo_joint"' in printed.output


@pytest.mark.parametrize(
    ("arguments", "status", "sentence"),
    [
        (["ra9"], 2, '"ra9" is not a robot of the plant arboleda; there are ra1, rm_sis_a, ra2, rm_sis_b, '),
        (["rm_sisa"], 2, '; did you mean "rm_sis_a"?'),
        (["ra1", "--plant", "nowhere.yaml"], 2, "nowhere.yaml: there is no such file"),
    ],
)
def test_a_robot_that_is_not_there_is_one_sentence(
    arguments: list[str],
    status: int,
    sentence: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture,
) -> None:
    monkeypatch.setattr(sys, "argv", ["arboleda", "urdf", *arguments])
    with pytest.raises(SystemExit) as end:
        main()
    said = capsys.readouterr()
    assert (end.value.code, said.out) == (status, "")
    assert sentence in said.err and said.err.count("\n") == 1


def test_without_the_xacro_library_a_sentence_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture
) -> None:
    monkeypatch.setitem(sys.modules, "xacro", None)
    monkeypatch.setattr(sys, "argv", ["arboleda", "urdf", "ra1"])
    with pytest.raises(SystemExit) as end:
        main()
    said = capsys.readouterr()
    assert (end.value.code, said.out) == (1, "")
    assert "pip install xacro" in said.err and "apt install ros-$ROS_DISTRO-xacro" in said.err
    assert said.err.count("\n") == 1


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty place for drawings instead of the shipped ones."""
    (tmp_path / "urdf").mkdir()
    monkeypatch.setattr(drawings, "files", lambda package: tmp_path)
    return tmp_path / "urdf"


def test_a_model_without_a_drawing_is_one_sentence(folder: Path) -> None:
    (folder / "mine.urdf.xacro").touch()
    with pytest.raises(StartError, match=r"scara of ra1 cannot be drawn: .*no urdf/scara.urdf.xacro; .*mine"):
        robot_urdf(shipped(), "ra1")


@pytest.mark.parametrize(
    "text", ["<robot", '<robot xmlns:xacro="http://ros.org/wiki/xacro" name="${nothing}"/>']
)
def test_a_damaged_drawing_is_one_sentence(folder: Path, text: str) -> None:
    (folder / "scara.urdf.xacro").write_text(text)
    with pytest.raises(StartError, match=r"urdf/scara.urdf.xacro cannot be processed: ") as refused:
        robot_urdf(shipped(), "ra1")
    assert "\n" not in str(refused.value)


def test_an_unknown_robot_of_the_api_is_bad_input() -> None:
    with pytest.raises(ConfigError, match='did you mean "ra1"'):
        robot_urdf(shipped(), "r1")
