"""A plant that really runs, as `arboleda up` does, for as long as a lesson needs it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from arboleda.client import Plant

LESSONS = Path(__file__).parent
ARBOLEDA = (sys.executable, "-c", "from arboleda.cli.main import main; main()")
PAGE = "Page: "
ENGLISH = {"ARBOLEDA_LANG": "en"}  # what the plant prints is read here, whatever the reader's language


@contextmanager
def running(plant: str, state: Path, rate: int = 10) -> Iterator[Plant]:
    """A plant of `plants/` on virtual devices, so many times as fast, that keeps its state in this folder."""
    options = ("up", "--no-ros", "--rate", rate, "--state", state, "--plant", LESSONS / "plants" / plant)
    command, spoken = [*ARBOLEDA, *map(str, options)], os.environ | ENGLISH
    up = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=spoken)
    try:
        assert up.stdout is not None
        address = next(line.removeprefix(PAGE).strip() for line in up.stdout if line.startswith(PAGE))
        with Plant(address) as client:
            yield client
    finally:
        up.terminate()
        up.communicate()
