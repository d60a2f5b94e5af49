"""State of a plant for /diagnostics: a level, a sentence and values for each robot and cell."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from arboleda.model.cell_states import CellState
from arboleda.model.facts import shown
from arboleda.model.sentence import Sentence
from arboleda.wire.status import ERROR, OK, STALE, WARN

from .alarms import AlarmLevel, PackageAlarm

Diagnostic = tuple[str, str, int, str, dict[str, str]]
TIMES = frozenset({"age_s", "telemetry_hz"})  # a diagnosis changes with the robot, not with time
UNKNOWN = "?"  # a fact that was not reported yet


def diagnostics(snapshot: dict[str, Any]) -> Iterator[Diagnostic]:
    """The (name, hardware id, level, message, values) of each robot and cell of a snapshot."""
    yield from map(_robot_diagnostic, snapshot["robots"])
    yield from map(_cell_diagnostic, snapshot["cells"])


def record(trouble: str) -> Diagnostic:
    """The status of the flight record; `trouble` is the reason why it stopped, "" while it is written."""
    return ("arboleda: record", "", WARN if trouble else OK, trouble or "written", {})


def memory(trouble: Sentence | None) -> Diagnostic:
    """The status of the plant's memory; `trouble` is a sentence if it is slow."""
    return ("arboleda: memory", "", WARN if trouble else OK, str(trouble or "commits are fast"), {})


def packages(alarms: Sequence[PackageAlarm]) -> Diagnostic:
    """The status of the packages of a plant: the alarms that they have raised."""
    level = ERROR if any(each.level is AlarmLevel.ERROR for each in alarms) else WARN if alarms else OK
    return ("arboleda: packages", "", level, "; ".join(str(each.said) for each in alarms) or "no alarm", {})


def _robot_diagnostic(robot: dict[str, Any]) -> Diagnostic:
    level = OK if robot["online"] else STALE
    if robot["online"] and robot["state"] not in (None, 0, 1):
        level = ERROR
    plain = {key: value for key, value in robot.items() if not isinstance(value, dict) and key not in TIMES}
    values = {key: str(value) for key, value in plain.items() if value is not None}
    if robot["telemetry_hz"] is not None:
        values["telemetry_hz"] = f"{robot['telemetry_hz']:.0f}"
    for name, fact in robot["facts"].items():
        values[f"facts.{name}"] = UNKNOWN if fact is None else shown(fact)
    return (f"arboleda: {robot['name']}", robot["mqtt"], level, str(robot["obstacle"] or "ready"), values)


def _cell_diagnostic(cell: dict[str, Any]) -> Diagnostic:
    well = (
        cell["state"] in (CellState.IDLE, CellState.EXECUTE) and not cell["paused"] and not cell["not_ready"]
    )
    message = str(cell["held_by"] or cell["not_ready"] or cell["waiting_for"] or cell["state"])
    values = {
        "state": cell["state"],
        "queued": str(len(cell["queue"])),
        "step": str(cell["step"] or ""),
        "waiting_for": str(cell["not_ready"] or cell["waiting_for"] or ""),
        "advice": ", ".join(str(each["said"]) for each in cell["advice"]),
    }
    level = OK if well else WARN
    return (f"arboleda: {cell['name']}", "", level, message, values)
