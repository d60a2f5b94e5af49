"""The records that a page can show beside its own: those of the same plant, as far as they are written."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from arboleda.model.plant_files import PlantFiles
from arboleda.model.recording import Limits
from arboleda.recorder.errors import NoRecord
from arboleda.recorder.files import part_path
from arboleda.rig.world import World
from arboleda.testing import shipped
from arboleda.views import view
from arboleda_proofs.campaigns.simulated_recorder import SimulatedRecorder
from arboleda_proofs.past import records
from arboleda_proofs.past.records import Records

MODEL = shipped("sis_a")
LAYOUT = view.layout(MODEL)
FILES = PlantFiles(plant="plant.yaml", contents={"plant.yaml": b"name: one\n"})
OTHER = replace(FILES, contents={"plant.yaml": b"name: two\n"})


def started(folder: Path, epoch: int, files: PlantFiles = FILES, began_s: float = 0.0) -> World:
    """A start whose record is written while time passes."""
    recorder = SimulatedRecorder(folder, files, Limits(), round(began_s * 1e9))
    world = World(MODEL, epoch=epoch, make_plant=recorder.plant)
    world.request_task("sis_a 0B 7")
    world.advance(30.0)
    return world


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Starts of which 7 and 8 had the same plant file, 9 another one, and 10 has nothing to be read."""
    folder = tmp_path_factory.mktemp("record")
    for epoch, files in ((7, FILES), (8, FILES), (9, OTHER)):
        started(folder, epoch, files, began_s=1000.0 * epoch)
    part_path(folder, 10, 1).write_bytes(b"")
    return folder


@pytest.fixture
def shown(written: Path, tmp_path: Path) -> Records:
    """Those of the start 8."""
    shutil.copytree(written, tmp_path, dirs_exist_ok=True)
    return Records(lambda: part_path(tmp_path, 8, 1), lambda: LAYOUT, str)


def test_those_of_the_same_plant_file_can_be_chosen(shown: Records) -> None:
    found = [(start.epoch, start.is_own, start.is_same) for start in shown.starts()]
    assert found == [(9, False, False), (8, True, True), (7, False, True)]
    assert shown.past(7).began < shown.past(8).began == shown.past().began


@pytest.mark.parametrize("epoch", [9, 10, 11])
def test_what_this_page_cannot_show_is_a_sentence(shown: Records, epoch: int) -> None:
    with pytest.raises(NoRecord, match="There is no record of this start, or it had another plant file"):
        shown.past(epoch)


def test_a_copy_elsewhere_stands_alone(shown: Records, tmp_path: Path) -> None:
    copy = tmp_path / "night.mcap"
    copy.write_bytes(part_path(tmp_path, 8, 1).read_bytes())
    alone = Records(lambda: copy, lambda: LAYOUT, str)
    assert alone.starts() == [] and alone.past().began == shown.past().began


def test_a_record_that_is_written_on_grows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    world = started(tmp_path, 7)
    grows = Records(lambda: part_path(tmp_path, 7, 1), lambda: LAYOUT, str)
    past = grows.past()
    ended, tasks = past.ended, _tasks(past)
    world.request_task("sis_a 1C 3")
    world.advance(60.0)
    assert grows.past().ended == ended, "it is not looked at each time"
    monkeypatch.setattr(records, "FRESH_S", -1.0)
    assert grows.past() is past
    assert past.ended > ended + 50_000 and _tasks(past) == tasks + 1
    assert past.face(past.ended, "en")["text/sis_a.task"][0].startswith("sis_a 1C 3")


def _tasks(past: Any) -> int:
    return len(past.face(past.ended, "en")["rows/tasks"])
