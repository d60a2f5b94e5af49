"""`arboleda record` and `arboleda record replay` on what a plant has written that does not run any more."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from arboleda.plant_file import loader
from arboleda.recorder import files
from arboleda.runtime.build import Options, build

SHIPPED = loader.load_recorded()[1]
TASK = "sis_a 0B 7 #lot-1"


def test_without_its_library_the_plant_goes_on_without_a_record(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    for name in ("arboleda.recorder.recorder", "arboleda.recorder.files"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.setitem(sys.modules, "mcap.writer", None)
    app = build(loader.load(), {"orchestrator"}, Options(state_dir=tmp_path, recording=SHIPPED))
    app.start()
    try:
        assert app.plant.submit(TASK).result(30.0).state.value == "queued"
    finally:
        app.stop()
    assert "no record is written: " in caplog.text and not (tmp_path / files.FOLDER).exists()
