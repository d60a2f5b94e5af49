"""Damages to copies of a memory find what a start would not notice."""

from __future__ import annotations

import random
import shutil
from pathlib import Path

import pytest

from arboleda.store.sqlite import Store
from arboleda_kills.damages import WAYS, unnoticed

from ..store.memory_samples import ended, queued

FILES = 4  # the memory, its log, the index of that, and the mark


@pytest.fixture
def killed(tmp_path: Path) -> Path:
    """The state of a plant that was killed after it had told that a task is done."""
    (tmp_path / "work").mkdir()
    with Store(tmp_path / "work" / "plant.sqlite") as store:
        store.tasks.keep(queued("a"), "storage", 1.0)
        store.tasks.keep(ended("a"), "storage", 2.0)
        store.sync()
        shutil.copytree(tmp_path / "work", tmp_path / "killed")
    return tmp_path / "killed"


def test_each_damage_to_what_a_kill_has_left_is_noticed(killed: Path) -> None:
    tried = unnoticed(killed, {"a": "sis_a 0B 1"}, {"a": "done"}, random.Random(1))
    assert tried == (FILES * len(WAYS), [])


def test_a_start_that_would_know_less_is_named(killed: Path) -> None:
    (killed / "plant.told").unlink()
    _, silent = unnoticed(killed, {"a": "sis_a 0B 1"}, {"a": "done"}, random.Random(1))
    assert "remove plant.sqlite-wal: a start does not know a" in silent
