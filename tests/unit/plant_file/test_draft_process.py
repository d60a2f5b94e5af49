"""The check of a draft in a process of its own."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ArboledaError
from arboleda.plant_file.draft_process import CheckProcess
from arboleda.recorder.preamble import PlantFiles

FOLDER = Path(__file__).parents[3] / "examples/own_tree"
CONTENTS = {name: (FOLDER / name).read_bytes() for name in ("plant.yaml", "tend.xml")}


def test_it_says_what_check_says_and_what_it_read() -> None:
    process, plant = CheckProcess(), FOLDER / "plant.yaml"
    found = process.check(PlantFiles(plant="plant.yaml", contents=CONTENTS), plant)
    assert found.problems == () and found.read is not None and found.read.contents == CONTENTS
    wrong = {**CONTENTS, "plant.yaml": CONTENTS["plant.yaml"].replace(b"model: scara", b"model: scora")}
    found = process.check(PlantFiles(plant="plant.yaml", contents=wrong), plant)
    assert found.problems[0].startswith(f"{plant}:") and "scora" in found.problems[0]


def test_a_process_that_was_stopped_begins_no_check() -> None:
    process = CheckProcess()
    process.stop()
    with pytest.raises(ArboledaError, match="the plant ends"):
        process.check(PlantFiles(plant="plant.yaml", contents=CONTENTS), FOLDER / "plant.yaml")
