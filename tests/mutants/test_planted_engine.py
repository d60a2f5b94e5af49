"""Bugs of the engine are found by the simulator, most of them, and by the tests, nearly all of the others."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from ..lengths import length

ROOT = Path(__file__).parents[2]
A_FEW = ("--only", "recipes/decorators.py", "--sample", "2", "--seeds", "2", "--simulator-alone")
LEAST_BY_SIMULATOR, LEAST = 0.6, 0.95


@pytest.mark.timeout(12 * 3600)  # as a whole it takes hours
def test_most_bugs_of_the_engine_are_found(tmp_path: Path) -> None:
    """A few of them in short: that bugs are planted, and found."""
    planted, alone, tests, argued = _counts(tmp_path, length(A_FEW, whole=()))
    assert alone >= length(1, whole=LEAST_BY_SIMULATOR * planted)
    assert alone + tests + argued >= length(1, whole=LEAST * planted)


def _counts(state: Path, options: tuple[str, ...]) -> list[int]:
    """The last row of the table: how many there are, and how many came to which end."""
    command = (sys.executable, "-m", "tests.mutants.planted_engine", "--state", str(state), *options)
    environment = {"PYTHONPATH": "mutation", "PATH": "/usr/bin:/bin"}
    said = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert said.returncode in (0, 1), said.stderr
    last = said.stdout.splitlines()[-1].split()
    assert last[0] == "all", said.stdout
    return [int(number) for number in last[1:5]]
