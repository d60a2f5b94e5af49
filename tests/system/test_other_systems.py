"""A real plant on a Python that has no more than those of Windows and macOS, as far as Linux can look so."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from ..lengths import sample
from .conftest import Process, paths

pytestmark = pytest.mark.system
TESTS = str(Path(__file__).parents[1])
MAIN = """
import sys; sys.path[:0] = [sys.argv.pop(1)]
import lesser_host; lesser_host.pretend(sys.argv.pop(1))
from arboleda.cli.entry import main
main()
"""


@pytest.mark.parametrize("platform", sample(["win32", "darwin"], every=2))
def test_a_plant_does_a_task_and_keeps_a_second_one_out(
    start: Callable[..., Process], tmp_path: Path, free_port: int, platform: str
) -> None:
    def arboleda(*words: str) -> Process:
        state = ("--state", str(tmp_path / "state"))
        return start(sys.executable, "-c", MAIN, TESTS, platform, *words, *state, env={"PYTHONPATH": paths()})

    up = arboleda("up", "--no-ros", "--rate", "20", "--port", str(free_port))
    up.wait_for("HTTP API")
    task = arboleda("submit", "sis_a 0B 7", "--wait")
    assert task.wait() == 0, task.output
    second = arboleda("up", "--no-ros", "--port", str(free_port))
    assert second.wait() == 1
    assert "A plant is already running" in second.output and f"process {up.pid}" in second.output
    stop = arboleda("stop")
    assert stop.wait() == 0, stop.output
    assert up.interrupt() == 0, up.output
