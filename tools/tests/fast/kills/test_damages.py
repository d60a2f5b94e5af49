"""Damages to copies of a memory find what a start would not notice."""

from __future__ import annotations

import random
import shutil
import time
from pathlib import Path

import pytest
from tests.unit.recorder.recorded import beginning_of
from tests.unit.store.memory_samples import ended, queued

from arboleda.model.recording import Limits
from arboleda.recorder.files import FOLDER
from arboleda.recorder.writing import Writing
from arboleda.runtime.state import StateDir
from arboleda.store.sqlite import Store
from arboleda.testing import shipped
from arboleda_kills import damages
from arboleda_kills.damages import WAYS, unnoticed

FILES = 7  # the memory, its log, the index of that, the mark; number of the start, lock, record


@pytest.fixture
def killed(tmp_path: Path) -> Path:
    """The state of a plant that was killed after it had told that a task is done."""
    (tmp_path / "work").mkdir()
    with Store(tmp_path / "work" / "plant.sqlite") as store:
        store.tasks.keep(queued("a"), "storage", 1.0)
        store.tasks.keep(ended("a"), "storage", 2.0)
        store.sync()
        shutil.copytree(tmp_path / "work", tmp_path / "killed")
    with StateDir(tmp_path / "killed") as owner:
        owner.next_epoch(int(time.time()) - 60)
    writing = Writing(tmp_path / "killed" / FOLDER, beginning_of(shipped("sis_a")), Limits(), least_free=0)
    for _ in range(2):
        writing.open()
        writing.drop()
    return tmp_path / "killed"


def test_each_damage_to_what_a_kill_has_left_is_noticed(killed: Path) -> None:
    tried = unnoticed(killed, {"a": "sis_a 0B 1"}, {"a": "done"}, random.Random(1))
    assert tried == (FILES * len(WAYS), [])


@pytest.mark.parametrize("seed", range(8))
def test_no_damage_lets_a_start_have_a_number_that_robots_do_not_obey(killed: Path, seed: int) -> None:
    _, silent = unnoticed(killed, {}, {}, random.Random(seed))
    assert silent == []


def test_a_start_whose_number_is_not_higher_is_named(killed: Path) -> None:
    (killed / "epoch").write_text("9999999")  # without the checksum
    found = [unnoticed(killed, {}, {}, random.Random(seed))[1] for seed in range(20)]
    assert any("cut epoch: a start is number" in each for silent in found for each in silent)


def test_a_start_that_deletes_a_record_is_named(killed: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(damages, "NOTHING_IS_OLD_S", 1e9)
    _, silent = unnoticed(killed, {}, {}, random.Random(1))
    assert "cut epoch: a start deletes the record" not in silent, "that start is refused"
    assert "remove epoch: a start deletes the record" in silent


def test_a_start_that_would_know_less_is_named(killed: Path) -> None:
    (killed / "plant.told").unlink()
    _, silent = unnoticed(killed, {"a": "sis_a 0B 1"}, {"a": "done"}, random.Random(1))
    assert "remove plant.sqlite-wal: a start does not know a" in silent
