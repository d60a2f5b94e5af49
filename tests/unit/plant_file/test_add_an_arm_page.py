"""docs/how-to/add-an-arm.md: its arm is one, in both forms, and `check` says what the page says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.geometry import bodies, kinematics
from arboleda.model.errors import ConfigError
from arboleda.plant_file import loader
from arboleda.plant_file.own_models import ENDINGS, FULL_SPEED_S, LEAST_STEP, MOST_JOINTS, STEP_DEG, STEP_MM
from arboleda.plant_file.shapes import ModelShape, OffsetShape
from arboleda.plant_file.urdf import robot_urdf

PAGE = (Path(__file__).parents[3] / "docs/how-to/add-an-arm.md").read_text("utf-8")
URDF = PAGE.partition("```xml\n")[2].partition("```")[0]
PLANT, YAML = (part.partition("```")[0] for part in PAGE.split("```yaml\n")[1:])
SAID = [
    line for block in PAGE.split("```")[1::2] for line in block.splitlines() if re.match(r"\S+\.\w+:", line)
]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The page's files, and the folder in which its commands are typed."""
    (tmp_path / "models").mkdir()
    (tmp_path / "models/lift_arm.urdf").write_text(URDF, "utf-8")
    (tmp_path / "models/lift_arm.yaml").write_text(YAML, "utf-8")
    (tmp_path / "my_plant.yaml").write_text(PLANT, "utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def refused(model: str) -> tuple[str, ...]:
    Path("models/lift_arm.urdf").write_text(model, "utf-8")
    with pytest.raises(ConfigError) as refusal:
        loader.load(Path("my_plant.yaml"))
    return refusal.value.problems


def test_check_says_what_the_page_says(folder: Path) -> None:
    said = CliRunner().invoke(cli, ["check", "my_plant.yaml"])
    assert said.exit_code == 0 and said.output.splitlines()[:3] == SAID[:3] and said.output in PAGE


def test_the_mistakes_of_the_page_are_what_is_said(folder: Path) -> None:
    camera = (
        '<link name="camera"/><joint name="j" type="revolute"><parent link="carriage"/><child link="camera"/>'
    )
    ends = 'lower="-0.2" upper="0.1"'
    found = [
        *refused(URDF.replace(ends, 'lower="0.1" upper="0.4"')),
        *refused(URDF.replace('"shoulder" type="revolute"', '"shoulder" type="planar"')),
        *refused(
            URDF.replace('  <link name="upper_arm">', f"  {camera}</joint>\n  " + '<link name="upper_arm">')
        ),
    ]
    (folder / "models/lift_arm.urdf").unlink()
    with pytest.raises(ConfigError) as refusal:
        loader.load(Path("my_plant.yaml"))
    assert [*refusal.value.problems, *found] == SAID[3:]


def test_both_forms_are_the_same_arm(folder: Path) -> None:
    places = []
    for ending in ("urdf", "yaml"):
        text = PLANT.replace("lift_arm.urdf", f"lift_arm.{ending}")
        (folder / "my_plant.yaml").write_text(text, "utf-8")
        body = bodies.read(robot_urdf(loader.load(Path("my_plant.yaml")), "lifter"))
        places.append(kinematics.at(kinematics.tool(body, (-0.1, 0.7, -0.4))))
    assert places[0] == pytest.approx(places[1])


def test_the_page_has_every_key_and_every_default() -> None:
    rows = dict(re.findall(r"^\| `(\w+)` \| .*? \| (.*?) \|", PAGE, re.MULTILINE))
    assert set(rows) == set(ModelShape.model_fields)
    assert all(f"{key}: [" in PAGE for key in OffsetShape.model_fields)
    assert rows["accelerations"] == f"to full speed in {FULL_SPEED_S:g} s"
    assert rows["steps"] == f"{STEP_DEG:g} deg, {STEP_MM:g} mm"
    assert f"1 to {MOST_JOINTS} joints" in PAGE and f"{LEAST_STEP:g} at least" in PAGE
    assert all(f"`{ending}`" in PAGE for ending in ENDINGS)
