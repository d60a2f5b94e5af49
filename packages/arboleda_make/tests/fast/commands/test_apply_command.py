"""`arboleda apply` and `arboleda apply --list`."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.unit.cli.test_complaints import EVIL, complained, is_told_the_option
from typer.testing import CliRunner, Result

from arboleda.cli.main import cli
from arboleda.model.errors import ConfigError
from arboleda.plant_file.loader import load_with_files
from arboleda.plant_file.versions import FOLDER
from arboleda.runtime import at_work
from arboleda.runtime.state import StateDir

SOURCE = Path(__file__).parents[5] / "examples/own_tree"
AT = "2026-11-25T20:00:00+00:00"


@pytest.fixture
def plant(tmp_path: Path) -> Path:
    for name in ("plant.yaml", "tend.xml"):
        (tmp_path / name).write_bytes((SOURCE / name).read_bytes())
    return tmp_path / "plant.yaml"


@pytest.fixture
def started(plant: Path) -> Iterator[Path]:
    """A plant that runs with the files as they are now."""
    with StateDir(plant.parent / "state", plant="own_tree") as state:
        at_work.keep(state.path, load_with_files(plant)[1], AT)
        yield plant


def run(plant: Path, *words: str, says: str = "") -> Result:
    state = plant.parent / "state"
    return CliRunner().invoke(cli, [*words, "--plant", str(plant), "--state", str(state)], input=says)


def change(plant: Path, old: str, new: str) -> None:
    text = plant.read_text()
    assert old in text
    plant.write_text(text.replace(old, new))


def test_the_first_version_is_kept_and_then_nothing_is_new(plant: Path) -> None:
    first = run(plant, "apply", "--yes", "--note", "as delivered")
    assert first.exit_code == 0 and "version 1 is kept; the next start of the plant has it" in first.output
    again = run(plant, "apply", "--yes")
    assert again.exit_code == 0 and "there is nothing to put to work" in again.output
    assert "as delivered" in run(plant, "apply", "--list").output


@pytest.mark.long
def test_what_changed_is_shown_before_anything_is_kept(plant: Path) -> None:
    run(plant, "apply", "--yes")
    change(plant, "takes_s: 20", "takes_s: 25")
    refused = run(plant, "apply", says="n\n")
    assert refused.exit_code == 1 and "kind mill, run.takes_s: from 20 to 25" in refused.output
    assert "takes_s" not in run(plant, "apply", "--list").output
    assert "version 2 is kept" in run(plant, "apply", says="y\n").output
    assert "from 20 to 25" in run(plant, "apply", "--list").output


def test_what_check_refuses_changes_nothing(plant: Path) -> None:
    change(plant, "model: scara", "model: scora")
    refused = run(plant, "apply", "--yes")
    assert isinstance(refused.exception, ConfigError) and "scora" in str(refused.exception)
    assert not (plant.parent / FOLDER).exists()


@pytest.mark.long
def test_a_version_comes_back_as_a_new_one(plant: Path) -> None:
    before = plant.read_bytes()
    run(plant, "apply", "--yes")
    change(plant, "takes_s: 20", "takes_s: 25")
    (plant.parent / "tend.xml").write_text((SOURCE / "tend.xml").read_text().replace('"2"', '"3"', 1))
    run(plant, "apply", "--yes")
    back = run(plant, "apply", "--back", "1", "--yes")
    assert back.exit_code == 0 and "version 3 is kept" in back.output and "from 25 to 20" in back.output
    assert plant.read_bytes() == before
    assert (plant.parent / "tend.xml").read_bytes() == (SOURCE / "tend.xml").read_bytes()
    assert "version 1 again" in run(plant, "apply", "--list").output


@pytest.mark.long
def test_going_back_needs_no_plant_file_that_is_right_now(plant: Path) -> None:
    before = plant.read_bytes()
    run(plant, "apply", "--yes")
    plant.write_text("name: [\n")
    back = run(plant, "apply", "--back", "1", "--yes")
    assert back.exit_code == 0 and plant.read_bytes() == before


def test_a_version_that_is_no_plant_beside_todays_files_stays_where_it_is(plant: Path) -> None:
    run(plant, "apply", "--yes")
    change(plant, "takes_s: 20", "takes_s: 25")
    broken = next((plant.parent / FOLDER).rglob("files/plant.yaml"))
    broken.write_text(broken.read_text().replace("scara", "scora"))
    now = plant.read_bytes()
    refused = run(plant, "apply", "--back", "1", "--yes")
    assert "version 1 cannot be brought back" in str(refused.exception) and "scora" in str(refused.exception)
    assert plant.read_bytes() == now


def test_a_running_plant_is_what_is_compared_with_and_it_can_be_gone_back_to(started: Path) -> None:
    change(started, "takes_s: 20", "takes_s: 25")
    shown = run(started, "apply", "--yes")
    assert f"compared with what the plant was started with at {AT[:10]}" in shown.output
    assert "from 20 to 25" in shown.output and "what a device can do is agreed" in shown.output
    assert "version 2 is kept" in shown.output and shown.exit_code == 1
    assert "goes on as it is, and has it from its next start on" in shown.output  # it has no server here
    listed = run(started, "apply", "--list").output.splitlines()
    assert [line for line in listed if "at work" in line] == [
        listed[0]
    ] and "as the plant was started" in listed[0]


def test_the_shipped_plant_is_not_changed() -> None:
    refused = CliRunner().invoke(cli, ["apply", "--yes"])
    assert isinstance(refused.exception, ConfigError) and "arboleda new" in str(refused.exception)


def test_a_plant_file_without_its_option_is_taken_and_told_the_option(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    said = complained(["apply", f"my{EVIL}.yaml"], monkeypatch, capsys)
    assert is_told_the_option(said), said
