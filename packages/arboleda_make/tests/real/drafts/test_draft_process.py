"""The check of a draft in a process of its own."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import pytest

from arboleda.model.errors import ArboledaError
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_check import draft_check
from arboleda.plant_file.draft import DraftCheck
from arboleda_make.drafts import process as draft_process
from arboleda_make.drafts.process import CheckProcess

FOLDER = Path(__file__).parents[5] / "examples/own_tree"
CONTENTS = {name: (FOLDER / name).read_bytes() for name in ("plant.yaml", "tend.xml")}
FILES = PlantFiles(plant="plant.yaml", contents=CONTENTS)


def test_it_says_what_check_says_and_what_it_read() -> None:
    process, plant = CheckProcess(), FOLDER / "plant.yaml"
    found = process.check(FILES, plant)
    assert found.problems == () and found.read is not None and found.read.contents == CONTENTS
    assert found.unstated == draft_check.check(FILES, plant).unstated != ()
    wrong = {**CONTENTS, "plant.yaml": CONTENTS["plant.yaml"].replace(b"model: scara", b"model: scora")}
    found = process.check(PlantFiles(plant="plant.yaml", contents=wrong), plant)
    assert found.problems[0].startswith("plant.yaml:") and "scora" in found.problems[0]


@contextmanager
def slow_check(process: CheckProcess, gate: Path) -> Iterator[Future[DraftCheck]]:
    """A check that is under way until the block ends, and then gives no answer."""
    os.mkfifo(gate)
    with ThreadPoolExecutor(1) as thread, pytest.MonkeyPatch.context() as slow:
        slow.setattr(draft_process, "START", f"open({str(gate)!r}).read()")
        found = thread.submit(process.check, FILES, FOLDER / "plant.yaml")
        with gate.open("w"):  # open once the process has begun
            slow.undo()
            yield found


def test_a_check_waits_for_the_one_that_is_under_way(tmp_path: Path) -> None:
    process = CheckProcess()
    with ThreadPoolExecutor(1) as thread:
        with slow_check(process, tmp_path / "gate") as first:
            second = thread.submit(process.check, FILES, FOLDER / "plant.yaml")
            assert not first.done() and not second.done()
        assert isinstance(first.exception(), ArboledaError)
        assert second.result().problems == ()


def test_who_waits_for_a_check_hears_that_the_plant_ends(tmp_path: Path) -> None:
    process = CheckProcess()
    with ThreadPoolExecutor(1) as thread, slow_check(process, tmp_path / "gate"):
        second = thread.submit(process.check, FILES, FOLDER / "plant.yaml")
        process.stop()
        with pytest.raises(ArboledaError, match="the plant ends"):
            second.result()
