"""Bugs of the engine are found by the simulator alone."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from tests.lengths import length

ROOT = Path(__file__).parents[3]
A_FEW = ("--only", "bt_xml/running/leaves.py", "--sample", "2", "--seeds", "4", "--simulator-alone")
LEAST = 0.25  # what it found of 42 with twelve seeds of 30 s; these here are longer, and more


@pytest.mark.timeout(12 * 3600)  # as a whole it takes hours
def test_bugs_of_the_engine_are_found(tmp_path: Path) -> None:
    """A few of them in short: that bugs are planted, and found."""
    planted, alone = _counts(tmp_path, length(A_FEW, whole=("--simulator-alone",)))
    assert alone >= length(1, whole=LEAST * planted)


def _counts(state: Path, options: tuple[str, ...]) -> tuple[int, int]:
    """From the last row of the table: how many there are, and how many the simulator found."""
    command = (sys.executable, "-m", "tools.tests.mutants.planted_engine", "--state", str(state), *options)
    environment = {"PYTHONPATH": "tools:tools/mutation:tools/drawn", "PATH": "/usr/bin:/bin"}
    said = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert said.returncode in (0, 1), said.stderr
    last = said.stdout.splitlines()[-1].split()
    assert last[0] == "all", said.stdout
    return int(last[1]), int(last[2])
