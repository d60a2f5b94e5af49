"""The thread that writes the record is never in the way of the plant."""

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

from ..patience import PATIENCE_S
from ..unit.recorder.recorded import Site


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
