"""`arboleda record replay` with a fork: what a person types, and what is said."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.model.errors import ConfigError
from arboleda.plant_file import loader
from arboleda.recorder.chapter import Chapter
from arboleda.recorder.files import PartFile
from arboleda.recorder.steps import TOPIC, as_json
from arboleda.rig.world import World
from arboleda.runtime.rate import at_rate
from arboleda_proofs.campaigns.plants import Plant
from arboleda_proofs.campaigns.simulated_recorder import TapedPlant
from arboleda_proofs.playback.fork.settings import with_settings

Act = Callable[[World], None]
EXAMPLE = Path(__file__).parents[5] / "examples" / "lab_bench" / "plant.yaml"


def written(
    folder: Path,
    plant_file: Path | None,
    text: str,
    act: tuple[float, Act] | None,
    chapters: Sequence[Chapter] = (),
) -> Path:
    """The record of a simulated run of one task, in which something may go wrong, and what packages wrote."""
    model, recording = loader.load_recorded(plant_file)
    assert recording is not None
    make = partial(TapedPlant, files=recording.files)
    world = World(at_rate(Plant(declared=model).model, 1.0), now=1_700_000_000.0, make_plant=make)
    world.advance(2.0)
    world.request_task(text)
    if act is not None:
        world.at(world.now + act[0], lambda _: act[1](world))
    world.advance(60.0)
    plant = world.plant
    assert isinstance(plant, TapedPlant)
    path = folder / "7-0001.mcap"
    beginning = replace(plant.beginning, simulated=False)  # as of a plant that runs
    part = PartFile(path, beginning, 1, plant.tape[0].unix_ns)
    for step in plant.tape:
        part.put(TOPIC, step.unix_ns, as_json(step))
    for each in chapters:
        part.attach(each.name, each.unix_ns, each.data())
    part.close()
    return path


def power_off(world: World) -> None:
    world.power_off("ra_1")


@pytest.fixture(scope="module")
def failed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return written(tmp_path_factory.mktemp("record"), None, "sis_a 0B 7 #lot", (5.0, power_off))


def said(*args: str | Path, status: int) -> list[str]:
    outcome = CliRunner().invoke(cli, ["record", "replay", *map(str, args)], catch_exceptions=False)
    assert outcome.exit_code == status, outcome.output
    return outcome.output.splitlines()


def test_a_healthy_fork_says_step_by_step_what_is_otherwise(failed: Path) -> None:
    lines = said(failed, "--task", "lot", "--fork-at", stamp(4.0), "--healthy", status=1)
    assert "its devices are virtual" in lines[0] and "as in the record:" not in lines[1]
    assert "the first difference:" in lines
    assert lines[-3] == "task lot" and "failed sis_a 0B 7 (id lot): ra1: " in lines[-2]
    assert lines[-1].startswith("  fork") and lines[-1].endswith("done sis_a 0B 7 (id lot)")


def stamp(seconds: float) -> str:
    from datetime import datetime

    return datetime.fromtimestamp(1_700_000_000.0 + seconds).isoformat()


def shown(seconds: float) -> str:
    return stamp(seconds).replace("T", " ")


def test_a_fork_without_change_ends_as_recorded(failed: Path) -> None:
    lines = said(failed, "--fork-at", stamp(4.0), status=0)
    assert lines[1].startswith("  as in the record: ra1: silence from ")
    assert any(line.endswith("things happened as in the record, and no other ones") for line in lines)


def test_a_set_key_is_another_plant(failed: Path) -> None:
    lines = said(failed, "--set", "timing.dwell_s=0.9", "--fork-at", stamp(9.0), status=1)
    assert lines[1] == "  there the changed plant does otherwise for the first time"
    with pytest.raises(ConfigError, match='timing: the key "patience" is not known'):
        said(failed, "--set", "timing.patience=3", "--task", "lot", status=2)
    with pytest.raises(ConfigError, match="must be KEY=VALUE"):
        said(failed, "--set", "timing.dwell_s", "--task", "lot", status=2)


def test_a_fork_needs_a_time_where_nothing_is_changed(failed: Path) -> None:
    with pytest.raises(ConfigError, match="--fork-at TIME, or --task ID"):
        said(failed, "--healthy", status=2)
    with pytest.raises(ConfigError, match="no such task in this record that ran"):
        said(failed, "--healthy", "--task", "other", status=2)


def test_a_fork_before_the_first_step_begins_with_the_plant(failed: Path) -> None:
    lines = said(failed, "--fork-at", stamp(-60.0), status=0)
    assert lines[0].startswith("0 steps are executed as they were; from ") and shown(0.0) in lines[0]


def test_a_fork_after_the_last_step_is_refused_with_its_time(failed: Path) -> None:
    with pytest.raises(ConfigError, match=f"after the last step of the record, of {shown(62.0)[:16]}"):
        said(failed, "--fork-at", stamp(3600.0), status=2)


def test_a_recipe_stands_for_the_file_of_its_name(failed: Path, tmp_path: Path) -> None:
    other = tmp_path / "mine.py"
    other.write_text("")
    with pytest.raises(ConfigError, match="its recipes are those that come with Arboleda"):
        said(failed, "--recipe", other, "--task", "lot", status=2)


@pytest.mark.long
def test_another_recipe_is_for_tasks_that_begin_after_the_fork(tmp_path: Path) -> None:
    record = written(tmp_path, EXAMPLE, "bench weigh 5 #sample", None)
    other = tmp_path / "recipes.py"
    other.write_text(
        EXAMPLE.with_name("recipes.py").read_text("utf-8").replace("scale.tare(), ", ""), "utf-8"
    )
    lines = said(record, "--recipe", other, "--task", "sample", status=1)
    (tared,) = [line for line in lines if "scale" in line and "tare" in line]
    assert tared.split()[2] == "-"
    assert lines[-1].endswith("done bench weigh 5 (id sample)")
    assert said(record, "--recipe", other, "--fork-at", stamp(3.0), status=0)


def test_settings_leave_all_else_as_it_is_written() -> None:
    content = b'a: {on: yes, code: 012}\nb: [1, {c: "7"}]\n'
    assert with_settings(content, ["b.1.c=x", "d.e=[1, 2]"]) == (
        b"a: {on: yes, code: 012}\nb: [1, {c: x}]\nd:\n  e: [1, 2]\n"
    )
    with pytest.raises(ConfigError, match="'q' is in nothing that has keys"):
        with_settings(content, ["b.0.q=1"])
