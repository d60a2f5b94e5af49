"""The check of a draft in a process of its own."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from arboleda.model.errors import ArboledaError
from arboleda.plant_file import draft_process
from arboleda.plant_file.draft_check import Checked
from arboleda.plant_file.draft_process import CheckProcess
from arboleda.recorder.preamble import PlantFiles

FOLDER = Path(__file__).parents[3] / "examples/own_tree"
CONTENTS = {name: (FOLDER / name).read_bytes() for name in ("plant.yaml", "tend.xml")}
FILES = PlantFiles(plant="plant.yaml", contents=CONTENTS)


def test_it_says_what_check_says_and_what_it_read() -> None:
    process, plant = CheckProcess(), FOLDER / "plant.yaml"
    found = process.check(FILES, plant, waits=False)
    assert found.problems == () and found.read is not None and found.read.contents == CONTENTS
    wrong = {**CONTENTS, "plant.yaml": CONTENTS["plant.yaml"].replace(b"model: scara", b"model: scora")}
    found = process.check(PlantFiles(plant="plant.yaml", contents=wrong), plant, waits=False)
    assert found.problems[0].startswith(f"{plant}:") and "scora" in found.problems[0]


def test_a_process_that_was_stopped_begins_no_check() -> None:
    process = CheckProcess()
    process.stop()
    with pytest.raises(ArboledaError, match="the plant ends"):
        process.check(FILES, FOLDER / "plant.yaml", waits=True)


def test_while_one_check_is_under_way_one_more_waits_and_others_are_refused(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    process, gate = CheckProcess(), tmp_path / "gate"
    os.mkfifo(gate)

    def check(*, waits: bool) -> Checked:
        return process.check(FILES, FOLDER / "plant.yaml", waits=waits)

    with ThreadPoolExecutor() as threads, monkeypatch.context() as slow:
        slow.setattr(draft_process, "START", f"open({str(gate)!r}).read()")
        first = threads.submit(check, waits=False)
        opened = gate.open("w")  # once the process of the first has begun
        slow.undo()
        second = threads.submit(check, waits=True)
        with pytest.raises(ArboledaError, match="being checked already"):
            check(waits=False)
        opened.close()
        assert isinstance(first.exception(), ArboledaError)  # it said nothing
        assert second.result().problems == ()
