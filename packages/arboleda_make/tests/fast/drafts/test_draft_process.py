"""The check of a draft in a process of its own."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ArboledaError
from arboleda.model.plant_files import PlantFiles
from arboleda_make.drafts.process import CheckProcess

FOLDER = Path(__file__).parents[5] / "examples/own_tree"
CONTENTS = {name: (FOLDER / name).read_bytes() for name in ("plant.yaml", "tend.xml")}
FILES = PlantFiles(plant="plant.yaml", contents=CONTENTS)


def test_a_process_that_was_stopped_begins_no_check() -> None:
    process = CheckProcess()
    process.stop()
    with pytest.raises(ArboledaError, match="the plant ends"):
        process.check(FILES, FOLDER / "plant.yaml")
