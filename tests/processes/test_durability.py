"""The threads that write: what was told is synced, and the record is never in the way of the plant."""

from __future__ import annotations

import logging
import threading
from pathlib import Path

import pytest

from arboleda.core.plant import Plant
from arboleda.recorder import recorder
from arboleda.recorder.files import PartFile
from arboleda.recorder.recorder import Recorder
from arboleda.recorder.writing import Writing
from arboleda.runtime.parts.durability import Durability

from ..patience import PATIENCE_S, SOON_S
from ..unit.recorder.recorded import Site
from ..unit.runtime.syncs import Disk, People
from ..unit.runtime.syncs import disk as disk
from ..unit.runtime.syncs import durability as durability
from ..unit.runtime.syncs import people as people


def test_what_is_written_while_a_sync_is_under_way_is_not_durable_by_that(
    durability: Durability, disk: Disk, people: People
) -> None:
    disk.let_go.clear()
    durability.start()
    durability.wrote(precedes_commands=False)
    durability.tell("first")
    durability.wake()
    assert disk.reached.wait(SOON_S)
    durability.wrote(precedes_commands=False)
    durability.tell("last")
    assert not durability.reach(1, 0.0) and people.told == []
    disk.let_go.set()
    assert people.all_told.wait(SOON_S)
    assert people.told == [("first", None), ("last", None)]
    assert disk.syncs == 2 and durability.reach(2, 0.0)


def test_the_thread_folds_the_log_and_who_waits_for_a_sync_does_not(
    durability: Durability, disk: Disk
) -> None:
    durability.wrote(precedes_commands=True)
    durability.let_commands_leave()
    assert disk.folders == []
    durability.start()
    durability.wrote(precedes_commands=False)
    durability.wake()
    assert durability.reach(2, SOON_S)
    durability.stop()
    assert set(disk.folders) == {"durability"}


def test_what_is_left_at_the_end_is_synced_and_told(
    durability: Durability, disk: Disk, people: People
) -> None:
    disk.let_go.clear()
    durability.start()
    durability.wrote(precedes_commands=False)
    durability.tell("last")
    disk.let_go.set()
    durability.stop()
    assert people.told == [("last", None)]


class Threaded(Site):
    """One whose recorders have threads, as in plants that run."""

    def recorder(self, plant: Plant, writing: Writing) -> Recorder:
        made = Recorder(writing, lambda: round(plant.now * 1e9))
        made.start()
        return made


def test_a_disk_that_hangs_holds_up_no_step(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    hangs = threading.Event()
    monkeypatch.setattr(recorder, "MOST_WAITING", 50)
    monkeypatch.setattr(PartFile, "put", lambda *_: hangs.wait(PATIENCE_S))
    site = Threaded(tmp_path, monkeypatch)
    site.work("sis_a 0B 7")
    assert site.rig.changes[-1].state.value == "done"
    assert [each.getMessage() for each in caplog.records if each.levelno >= logging.WARNING] == [
        "the record has stopped: the disk is too slow: 50 steps wait for it; the plant goes on without it"
    ]
    hangs.set()
    site.end()
