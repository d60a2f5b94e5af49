"""Keys of a cell that both forms of cells have: one of devices, and the short form for storage."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from arboleda.model.plant_model import Evidence, Link, Retry, Robot

from .document import Document, Place
from .shapes import AnyCellShape, RetryShape, TeachShape


def common_keys(document: Document, place: Place, shape: AnyCellShape | None) -> dict[str, Any] | None:
    """The values of these keys as `Cell` takes them; None, with the problems kept, where one is wrong."""
    retry = document.section(RetryShape, (*place, "retry"))
    teach = document.section(TeachShape, (*place, "teach"))
    if shape is None or retry is None or teach is None:
        return None
    return {
        "name": str(place[-1]),
        "queue_limit": shape.queue_limit,
        "goes_on": shape.on_restart == "go_on",
        "goes_on_after_absence": shape.on_absence == "go_on",
        "drive_to_start": shape.drive_to_start,
        "piece_check": shape.piece_check,
        "zone_wait_s": shape.zone_wait_s,
        "retry": Retry(**retry.model_dump()),
        "teach": teach.teach,
    }


def check_absence(document: Document, place: Place, on_absence: str, robots: Iterable[Robot]) -> None:
    """Keep a problem if a cell is to go on after an absence and a device cannot prove its acts meanwhile."""
    unproved = [
        robot.name for robot in robots if robot.link is not Link.NONE and robot.evidence is not Evidence.IDS
    ]
    if on_absence == "go_on" and unproved:
        rule = "go_on needs evidence: ids of each device, which proves what it did meanwhile"
        document.problem((*place, "on_absence"), f"{rule}; {unproved[0]} has none")
