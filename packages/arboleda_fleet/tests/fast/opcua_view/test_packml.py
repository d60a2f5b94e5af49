"""The variables of a cell for a SCADA or a MES: PackML's numbers, and the same paths in every snapshot."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.model.cell_states import CellState
from arboleda.rig.rig import Rig
from arboleda.testing import shipped
from arboleda.views import view
from arboleda_fleet.opcua_view.packml import STATES, Counts, tags

CELL: dict[str, Any] = {
    "name": "line",
    "state": "idle",
    "task": None,
    "step": None,
    "queue": [],
    "paused": False,
    "waiting_for": None,
    "not_ready": None,
    "blocked_by": None,
    "held_by": None,
    "teaching": None,
    "devices": [{"name": "belt_1", "role": "belt", "holds": "full"}],
    "places": [{"name": "tray", "parts": 2}],
}
ROBOT = {"name": "belt_1", "online": True, "state": 2, "holding": None, "question": None}


def values(robot: dict[str, Any] = ROBOT, **changes: Any) -> dict[str, Any]:
    """The values of the cell by path, with these changes in its snapshot."""
    snapshot = {"cells": [CELL | changes], "robots": [robot], "tasks": []}
    found = tags(snapshot, {"line": Counts(ended=3, failed=1)}, {"line": {"oee": 0.25}})
    return {"/".join(tag.path): tag.value for tag in found["line"]}


def test_every_state_of_a_cell_has_its_number() -> None:
    assert set(STATES) == set(CellState)
    assert values()["Status/StateCurrent"] == 4
    assert values(state="held", held_by="the part fell")["Status/StateCurrent"] == 11


def test_a_cell_that_is_taught_is_in_manual_mode() -> None:
    assert values()["Status/UnitModeCurrent"] == 1
    assert values(teaching={"teacher": "ana"})["Status/UnitModeCurrent"] == 3


@pytest.mark.parametrize("state", ["held", "aborted", "stopped"])
def test_a_cell_that_needs_somebody_has_an_alarm_that_says_why(state: str) -> None:
    found = values(state=state, held_by="the part fell")
    assert (found["Admin/Alarm/Trigger"], found["Admin/Alarm/Message"]) == (True, "the part fell")
    assert (values()["Admin/Alarm/Trigger"], values()["Admin/Alarm/Message"]) == (False, "")


def test_tasks_counts_and_figures() -> None:
    found = values(task={"id": "t1", "text": "line 200"}, step="belt load", queue=["t2", "t3"])
    assert [found[f"Task/{key}"] for key in ("Id", "Text", "Step", "Waiting")] == [
        "t1",
        "line 200",
        "belt load",
        2,
    ]
    assert (found["Admin/ProdProcessedCount"], found["Admin/ProdDefectiveCount"]) == (3, 1)
    assert (found["Oee/OEE"], found["Oee/Quality"]) == (0.25, None)


def test_devices_and_the_parts_that_they_hold() -> None:
    found = values()
    assert found["Devices/belt/State"] == "fault"
    assert (found["Devices/belt/Part"], found["Places/tray/Parts"]) == ("", 2)
    assert values(ROBOT | {"holding": "cup", "state": None})["Devices/belt/Part"] == "cup"


def test_a_real_plant_has_the_same_paths_at_rest_and_at_work() -> None:
    rig = Rig(shipped("sis_a"))
    before = {each: [tag.path for tag in found] for each, found in of(rig).items()}
    rig.submit("sis_a 0B 7")
    rig.advance(5.0)
    at_work = of(rig)
    assert {each: [tag.path for tag in found] for each, found in at_work.items()} == before
    found = {tag.path: tag.value for tag in at_work["sis_a"]}
    assert (found["Status", "StateCurrent"], found["Task", "Text"]) == (6, "sis_a 0B 7")


def of(rig: Rig) -> Any:
    return tags(view.snapshot(rig.plant), {}, {})
