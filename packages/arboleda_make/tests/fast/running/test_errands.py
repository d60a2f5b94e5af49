"""Errands about a draft: after the end of the plant none begins."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ArboledaError
from arboleda.model.plant_files import PlantFiles
from arboleda_make.trying.errands import ENDING, ErrandRun, Work


def test_after_the_end_nothing_begins(tmp_path: Path) -> None:
    run = ErrandRun(Work(module="trial", command="prove"), tmp_path / "kept")
    run.end()
    with pytest.raises(ArboledaError, match=ENDING):
        run.begin(PlantFiles(plant="plant.yaml", contents={}), tmp_path / "plant.yaml", {})
    assert run.state() == {"state": "idle"} and not run.folder.exists()
