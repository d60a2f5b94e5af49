"""What tests do on the page, in a real chromium."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx

from arboleda.model.messages import ENDED, TaskState

from ..patience import PATIENCE_S
from ..patience import until as until
from .conftest import Process, paths

PARTS = ("cells", "tasks", "make", "draw", "events", "links", "settings")
PLACES = {"draw": "make", "teach": "make", "events": "log", "links": "log"}  # of parts that share one


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
    if part in PLACES:
        page.click(f".tabs [data-tab={PLACES[part]}]")
        page.click(f".within [data-tab={part}]")
    else:
        page.click(f".tabs [data-tab={part}]")


def operate(page: Any, of: str = "") -> None:
    """Open the menu of a cell, or of the whole plant."""
    if of:
        show(page, "cells")
    page.click(f"[data-menu='{of}'][aria-expanded=false]")
    page.wait_for_selector("#menu")


def lead_out(address: str) -> bool:
    """Do what the plant advises first for each cell in trouble; True where no cell is in any.

    A busy machine brings trouble of its own: who got no time for a second holds cells, or is not heard.
    """
    with _api(address) as plant:
        cells = plant.get("/api/plant").raise_for_status().json()["cells"]
        troubled = [cell["advice"][0] for cell in cells if cell["advice"]]
        for advice in troubled:
            if not advice["hand"] and not advice["refusal"]:  # refused meanwhile: the next look says what now
                where = f"/api/cells/{advice['scope']}/{advice['do']}"
                told = advice["arguments"] | ({"by_hand": True} if advice["by_hand"] else {})
                plant.post(where, json=told or None)
    return not troubled and all(cell["state"] in ("idle", "execute") for cell in cells)


def ended(address: str, *tasks: str) -> None:
    """These tasks have ended; by advice too, where the machine was too busy for one."""

    def have_ended() -> bool:
        with _api(address) as plant:
            rows = [plant.get(f"/api/tasks/{task}").raise_for_status().json() for task in tasks]
        if all(TaskState(row["state"]) in ENDED for row in rows):
            return True
        lead_out(address)
        return False

    until(have_ended)


def _api(address: str) -> httpx.Client:
    return httpx.Client(base_url=address, trust_env=False, timeout=PATIENCE_S)
