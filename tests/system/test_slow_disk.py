"""A plant whose disk is slow says so, with what it means."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.request import urlopen

import pytest

from .conftest import paths

pytestmark = pytest.mark.system
SLOW_S = 0.15
ON_A_SLOW_DISK = f"""
import time
from arboleda.store.sqlite import Store
wait = Store._wait_for_disk
def slowly(self):
    time.sleep({SLOW_S})
    wait(self)
Store._wait_for_disk = slowly
from arboleda.cli.main import main
main()
"""


def test_a_slow_disk_is_said_in_the_log_and_by_a_metric(
    start: Callable[..., Any], typed: Callable[..., tuple[int, str]], tmp_path: Path
) -> None:
    up = ("up", "--no-ros", "--state", str(tmp_path / "state"))
    plant = start(sys.executable, "-c", ON_A_SLOW_DISK, *up, env={"PYTHONPATH": paths()})
    plant.wait_for("HTTP API")
    for number in range(1, 7):
        assert typed("submit", f"sis_a 0B {number}")[0] == 0
    plant.wait_for("the plant's memory is slow: whatever needs a commit waits")
    page = next(found[1] for line in plant.lines if (found := re.match(r"Page: (\S+)", line)))
    with urlopen(f"{page}/metrics") as answer:
        metrics = answer.read().decode()
    assert "arboleda_memory_slow 1.0" in metrics
    assert 'arboleda_commit_seconds_bucket{le="0.1"} 0.0' in metrics
    assert plant.interrupt() == 0
