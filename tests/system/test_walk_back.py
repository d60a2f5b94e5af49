"""`arboleda up` killed with -9 in the middle of a task, on boards that live on in a process of their own."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from arboleda.model.messages import MotionState
from arboleda_kills.deeds import Did
from arboleda_kills.processes import PATIENCE_S, Boards, Plant

from .patient_plant import patient_plant

pytestmark = pytest.mark.system

TASK = {"text": "sis_a 0B 7 #lot-1"}


class Site:
    """A plant that is killed and started again, and its boards."""

    def __init__(self, folder: Path, *options: str) -> None:
        self._options = ("--plant", str(patient_plant(folder)), *options)
        self.boards = Boards(1.0, folder / "boards.log")
        self._folder = folder
        self.moves = False  # whether a robot of the cell does
        self.plant = self._start()

    def kill(self) -> None:
        """kill -9 and a new start; meanwhile the usual port may be that of another plant's broker."""
        self.plant.kill()
        self.boards.leave()
        self.plant = self._start()

    def until(self, what: Callable[[dict[str, Any]], Any]) -> dict[str, Any]:
        """The row of the cell, once it is so."""
        patience = time.time() + PATIENCE_S
        cell: dict[str, Any] = {}
        while time.time() < patience:
            self.plant.check()
            _, snapshot = self.plant.ask("GET", "/api/plant")
            cell = next(each for each in snapshot["cells"] if each["name"] == "sis_a")
            own = [each["name"] for each in cell["devices"]]
            robots = [each for each in snapshot["robots"] if each["name"] in own]
            self.moves = any(each["state"] == MotionState.MOVING for each in robots)
            if what(cell):
                return cell
            time.sleep(0.05)
        raise AssertionError(cell)

    def end(self) -> None:
        self.plant.kill()
        self.boards.end()

    def _start(self) -> Plant:
        plant = Plant(self._folder / "state", self._folder / "plant.log", self.boards.broker, self._options)
        assert plant.await_api(time.time() + PATIENCE_S)
        return plant


@pytest.fixture
def site(tmp_path: Path) -> Iterator[Site]:
    made = Site(tmp_path)
    yield made
    made.end()


def test_a_killed_plant_finishes_its_task_after_resume(site: Site) -> None:
    site.until(lambda cell: cell["not_ready"] is None)
    assert site.plant.ask("POST", "/api/tasks", TASK)[0] == 202
    for step in ("drive path 0B", "move to station 7", "move to home"):
        site.until(lambda cell, step=step: cell["step"] == step)
        site.until(lambda _: site.moves)
        site.kill()
        cell = site.until(lambda cell: cell["state"] == "held" and "resume" not in cell["refused"])
        at = f'task lot-1 was at work when the plant stopped, at its step "{step}"'
        assert cell["held_by"] == f"sis_a is held ({at}); resume sis_a or abandon sis_a"
        assert site.plant.ask("POST", "/api/cells/sis_a/resume")[0] == 200
    site.until(lambda cell: cell["state"] == "idle")
    (row,) = site.plant.ask("GET", "/api/history")[1]
    assert (row["id"], row["state"]) == ("lot-1", "done"), row
    parts = [(deed.did, deed.what) for deed in site.boards.deeds if deed.did is not Did.WAS_TOLD]
    assert parts == [(Did.PICKED, "pick-up"), (Did.LET_GO, "station 7")]
