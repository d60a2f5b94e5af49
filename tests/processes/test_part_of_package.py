"""A part of a package in a plant that runs: its rows are written for any thread, and it delays nobody."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from tests.added_package import install
from tests.patience import PATIENCE_S

from arboleda.runtime.build import App, Options, build
from arboleda.testing import shipped

CODE = """
import threading

from arboleda.extension import Part


class Orders(Part):
    def start(self):
        self.hangs, self.goes_on = threading.Event(), threading.Event()
        self.plant.on_task(self.hang)

    def hang(self, task):
        self.hangs.set()
        self.goes_on.wait()

    def poll(self):
        raise OSError("the line is cut")
"""


@contextmanager
def started(tmp_path: Path) -> Iterator[App]:
    install(tmp_path / "site", "orders", CODE, what="Orders")
    made = build(shipped("sis_a"), {"orchestrator"}, Options(state_dir=tmp_path / "state", page=False))
    made.start()
    yield made
    part_of(made).goes_on.set()
    made.stop()
    sys.modules.pop("orders", None)


@pytest.fixture
def app(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[App]:
    monkeypatch.syspath_prepend(tmp_path / "site")
    with started(tmp_path) as made:
        yield made


def part_of(app: App) -> Any:
    return app.offers.ask(sys.modules["orders"].Orders)


def test_any_thread_puts_rows(app: App) -> None:
    table = part_of(app).plant.table()
    names = [f"lot{each}" for each in range(20)]
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda name: table.put({name: {"amount": 1}}), names, timeout=PATIENCE_S))
    assert part_of(app).plant.table().rows() == {each: {"amount": 1} for each in names}


def test_a_listener_that_hangs_holds_up_no_task(app: App) -> None:
    part = part_of(app)
    part.plant.submit("sis_a 0B 7 #lot").result(PATIENCE_S)
    assert part.hangs.wait(PATIENCE_S)
    assert part.plant.submit("sis_a 0B 8 #next").result(PATIENCE_S).state == "queued"


def test_a_thread_of_a_part_that_dies_is_named_and_prints_no_traceback(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.syspath_prepend(tmp_path / "site")
    before = threading.excepthook
    with started(tmp_path) as app:
        thread = threading.Thread(target=part_of(app).poll, name="poll")
        thread.start()
        thread.join(PATIENCE_S)
    said = "Arboleda goes on without the thread poll of orders 1: OSError: the line is cut"
    assert app.notes[-1] == said and "Traceback" not in capsys.readouterr().err
    assert threading.excepthook is before


def test_a_start_says_once_which_part_is_left_out(tmp_path: Path) -> None:
    code = (
        "from arboleda.extension import Part\n\n\nclass Orders(Part):\n    def start(self):\n        1 / 0\n"
    )
    install(tmp_path / "site", "orders", code, what="Orders")
    words = ["up", "--once", "sis_a 0B 1", "--no-ros", "--rate", "10", "--state", str(tmp_path / "state")]
    environ = {**os.environ, "PYTHONPATH": str(tmp_path / "site"), "COLUMNS": "200"}
    run = [sys.executable, "-c", "from arboleda.cli.main import main; main()", *words]
    ran = subprocess.run(run, env=environ, capture_output=True, text=True, check=True)
    said = "Arboleda goes on without the part Orders of orders 1: ZeroDivisionError: division by zero"
    assert (ran.stdout + ran.stderr).count(said) == 1
