"""What tests do on the page, in a real chromium."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from arboleda.cli.client import PlantClient
from arboleda.model.messages import ENDED, TaskState, Verb

from ..patience import PATIENCE_S
from .conftest import Process, paths

PARTS = ("cells", "twin", "tasks", "panel", "make", "draw", "links", "events")


@contextmanager
def running(state: Path, *args: str) -> Iterator[str]:
    """A plant and its page's address."""
    main = "from arboleda.cli.main import main; main()"
    command = ("up", "--no-ros", "--rate", "10", "--state", str(state), *args)
    plant = Process(sys.executable, "-c", main, *command, env={"PYTHONPATH": paths()})
    try:
        plant.wait_for("HTTP API")
        yield next(line.split()[-1] for line in plant.lines if line.startswith("Page:"))
        assert plant.interrupt() == 0, plant.output
        assert "Traceback" not in plant.output, plant.output
    finally:
        plant.kill()


def connected(page: Any) -> None:
    page.wait_for_function("document.getElementById('connection')?.hidden")


def show(page: Any, part: str) -> None:
    page.click(f"[data-tab={part}]")


def until(condition: Callable[[], bool]) -> None:
    """Wait for what another process does."""
    ends = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < ends
        time.sleep(0.1)


def ended(plant: PlantClient) -> None:
    """Every task has ended, by advice too: a busy machine may hold cells, after a second of standstill."""
    for _ in plant.changes():
        now = plant.status()
        for cell in now["cells"]:
            if cell["state"] == "held":
                plant.operate(Verb(cell["advice"][0]["do"]), cell["advice"][0]["scope"])
        if all(TaskState(task["state"]) in ENDED for task in now["tasks"]):
            return
