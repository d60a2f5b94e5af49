"""Cell as PackML names it: the variables that a SCADA or a MES browses, out of a snapshot. Pure.

`Status` and `Admin` have the names and numbers of PackTags (ISA-TR88.00.02, OPC 30050); `Oee` those of
ISO 22400-2; the rest is the plant's own. docs/how-to/opcua-server.md says which are which.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from arboleda.drivers import MotionState
from arboleda.model.cell_states import CellState
from arboleda.views.alarms import needs_in

Type = Literal["Boolean", "Int32", "Double", "String"]
STATES = {
    CellState.CLEARING: 1,
    CellState.STOPPED: 2,
    CellState.IDLE: 4,
    CellState.EXECUTE: 6,
    CellState.ABORTING: 8,
    CellState.ABORTED: 9,
    CellState.HOLDING: 10,
    CellState.HELD: 11,
    CellState.RESETTING: 15,
}
"""The number of each state, as PackTags and OPC 30050 have them."""
PRODUCE, MANUAL = 1, 3
FIGURES = {"OEE": "oee", "Availability": "availability", "Performance": "performance", "Quality": "quality"}


@dataclass(frozen=True, kw_only=True)
class Tag:
    """Variable of a cell: its path below the cell, its type, and its value; None: there is none."""

    path: tuple[str, ...]
    type: Type
    value: bool | int | float | str | None


@dataclass(frozen=True, kw_only=True)
class Counts:
    """Tasks of a cell that have ended since the plant was started, and those of them that failed."""

    ended: int = 0
    failed: int = 0


def tags(
    snapshot: Mapping[str, Any], counts: Mapping[str, Counts], oee: Mapping[str, Mapping[str, Any]]
) -> dict[str, list[Tag]]:
    """The variables of each cell; the same paths for every snapshot of a plant.

    `oee`: the figures of cells that have some, as `Oee.data` has them.
    """
    robots = {row["name"]: row for row in snapshot["robots"]}
    needs = needs_in(dict(snapshot))
    return {
        cell["name"]: [
            *_status(cell),
            *_admin(cell, needs, counts.get(cell["name"], Counts())),
            *_task(cell),
            *_oee(oee.get(cell["name"], {})),
            *_devices(cell, robots),
            *_places(cell),
        ]
        for cell in snapshot["cells"]
    }


def _status(cell: Mapping[str, Any]) -> Iterator[Tag]:
    mode = PRODUCE if cell["teaching"] is None else MANUAL
    yield Tag(path=("Status", "UnitModeCurrent"), type="Int32", value=mode)
    yield Tag(path=("Status", "StateCurrent"), type="Int32", value=STATES[CellState(cell["state"])])
    yield Tag(path=("Status", "StateCurrentName"), type="String", value=cell["state"])


def _admin(cell: Mapping[str, Any], needs: Mapping[str, str], counts: Counts) -> Iterator[Tag]:
    need = needs.get(cell["name"])
    why = cell["held_by"] or cell["not_ready"] or need
    yield Tag(path=("Admin", "Alarm", "Trigger"), type="Boolean", value=need is not None)
    yield Tag(path=("Admin", "Alarm", "Message"), type="String", value="" if need is None else str(why))
    yield Tag(path=("Admin", "ProdProcessedCount"), type="Int32", value=counts.ended)
    yield Tag(path=("Admin", "ProdDefectiveCount"), type="Int32", value=counts.failed)


def _task(cell: Mapping[str, Any]) -> Iterator[Tag]:
    task = cell["task"] or {"id": "", "text": ""}
    step = None if cell["step"] is None else str(cell["step"])
    yield Tag(path=("Task", "Id"), type="String", value=task["id"])
    yield Tag(path=("Task", "Text"), type="String", value=task["text"])
    yield Tag(path=("Task", "Step"), type="String", value=step or "")
    yield Tag(path=("Task", "Waiting"), type="Int32", value=len(cell["queue"]))


def _oee(figures: Mapping[str, Any]) -> Iterator[Tag]:
    for name, key in FIGURES.items():
        yield Tag(path=("Oee", name), type="Double", value=figures.get(key))


def _devices(cell: Mapping[str, Any], robots: Mapping[str, Mapping[str, Any]]) -> Iterator[Tag]:
    for device in cell["devices"]:
        row, place = robots[device["name"]], ("Devices", device["role"])
        state = "" if row["state"] is None else MotionState(row["state"]).name.lower()
        yield Tag(path=(*place, "Name"), type="String", value=device["name"])
        yield Tag(path=(*place, "Online"), type="Boolean", value=bool(row["online"]))
        yield Tag(path=(*place, "State"), type="String", value=state)
        if device["holds"]:
            holding = row["holding"]
            yield Tag(path=(*place, "Part"), type="String", value="" if holding is None else str(holding))


def _places(cell: Mapping[str, Any]) -> Iterator[Tag]:
    for place in cell["places"]:
        yield Tag(path=("Places", place["name"], "Parts"), type="Int32", value=place["parts"])
