"""`arboleda simulate --record seed.mcap`: a seed is a flight record, for all that reads records."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest
from tests.lengths import sample
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.recorder import reader
from arboleda_proofs.playback.views import Views

from .test_simulate import PLANT

Said = Callable[..., list[str]]


def lines_in(folder: Path, patch: pytest.MonkeyPatch) -> Said:
    """The lines that a command says in this folder, in which there is the small plant."""
    patch.chdir(folder)
    Path("small.yaml").write_text(PLANT)

    def run(*words: object) -> list[str]:
        outcome = CliRunner().invoke(cli, [str(word) for word in words], catch_exceptions=False)
        assert outcome.exit_code == 0, outcome.output
        return outcome.output.splitlines()

    return run


@pytest.fixture
def said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Said:
    return lines_in(tmp_path, monkeypatch)


@pytest.fixture(scope="module")
def seed(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[str]]:
    """The record of a seed, and what was said."""
    folder = tmp_path_factory.mktemp("seed")
    with pytest.MonkeyPatch.context() as patch:
        lines = simulated(lines_in(folder, patch), "--record", "seed.mcap")
    return folder / "seed.mcap", lines


def simulated(said: Said, *words: object) -> list[str]:
    return said("simulate", "--plant", "small.yaml", "--cycles", 1, "--seed", 5, *words)


@pytest.mark.long
@pytest.mark.parametrize("link", sample(["mqtt", "ros", "none"], every=2))
def test_a_seed_is_a_record_that_is_equal_at_every_step(
    said: Said, seed: tuple[Path, list[str]], link: str
) -> None:
    if link == "mqtt":
        record, lines = seed
        shutil.copy(record, "seed.mcap")
    else:
        Path("small.yaml").write_text(PLANT.replace("link: mqtt", f"link: {link}"))
        lines = simulated(said, "--record", "seed.mcap")
    (steps,) = (line.split()[2] for line in lines if line.startswith("seed.mcap has "))
    assert said("record", "replay", "seed.mcap")[-1] == f"{steps.replace(',', '')} steps, all equal"
    assert "plant file: small.yaml" in said("record", "info", "seed.mcap")
    assert any("running   sis_a" in line for line in said("record", "logs", "seed.mcap"))


@pytest.mark.long
def test_to_record_a_seed_changes_nothing_of_it_and_is_the_same_every_time(
    said: Said, seed: tuple[Path, list[str]]
) -> None:
    record, lines = seed
    runs = [lines, *(simulated(said, *words) for words in (("--trace",), ("--record", "seed.mcap")))]
    digests = {line.split()[1] for run in runs for line in run if line.startswith("digest ")}
    assert len(digests) == 1
    assert record.read_bytes() == Path("seed.mcap").read_bytes()


@pytest.mark.long
def test_a_recorded_seed_can_be_looked_at(seed: tuple[Path, list[str]]) -> None:
    views = Views(reader.opened(seed[0]))
    assert any(row["state"] == "done" for row in views.at(views.ended_ns)["tasks"])


@pytest.mark.long
def test_each_start_of_a_seed_has_a_record(said: Said) -> None:
    crash = {"kind": "plant_crash", "at": 6.0, "seconds": 2.0}
    Path("crash.json").write_text(json.dumps({"faults": [crash]}))
    lines = simulated(said, "--faults", "crash.json", "--record", "seed.mcap")
    told = [line for line in lines if ".mcap has " in line]
    assert [line.split()[0] for line in told] == ["seed.mcap", "seed-2.mcap"]
    assert told[1].endswith(" steps, of start 2 of 2")
    for file in ("seed.mcap", "seed-2.mcap"):
        assert said("record", "replay", file)[-1].endswith("steps, all equal")


def test_a_file_that_is_there_is_not_written_over(said: Said) -> None:
    Path("seed.mcap").write_text("mine")
    outcome = CliRunner().invoke(cli, ["simulate", "--record", "seed.mcap"])
    assert str(outcome.exception) == "seed.mcap: is there already; name another file"
    assert Path("seed.mcap").read_text() == "mine"


def test_a_full_disk_is_laid_to_the_disk(said: Said, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=0))
    outcome = CliRunner().invoke(cli, ["simulate", "--plant", "small.yaml", "--record", "seed.mcap"])
    assert str(outcome.exception) == "seed.mcap: cannot be written: the disk has less than 200 MB left"
    assert [each.name for each in Path().iterdir()] == ["small.yaml"]
