"""State of a virtual vehicle, in the form of each version of VDA 5050."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import Any, Protocol

from .order import Course, RunningAction

BROKEN = {"2.0": "CONNECTIONBROKEN", "2.1": "CONNECTIONBROKEN", "3.0": "CONNECTION_BROKEN"}
NODE_KEYS = ("nodeId", "sequenceId", "released")
EDGE_KEYS = ("edgeId", "sequenceId", "released")


class Vehicle(Protocol):
    """Content of a state message: how a vehicle is."""

    node: str
    sequence: int
    at: tuple[float, float] | None
    course: Course
    actions: dict[str, RunningAction]
    errors: list[dict[str, Any]]
    driving: bool
    paused: bool
    loaded: bool
    charging: bool
    battery: float


def state_of(agv: Vehicle, faults: Collection[str], version: str) -> dict[str, Any]:
    """The body of a state message."""
    doing = agv.actions.values()
    body: dict[str, Any] = {
        "orderId": agv.course.id,
        "orderUpdateId": agv.course.update,
        "lastNodeId": agv.node,
        "lastNodeSequenceId": agv.sequence,
        "nodeStates": _part(agv.course.nodes, NODE_KEYS),
        "edgeStates": _part(agv.course.edges, EDGE_KEYS),
        "driving": agv.driving,
        "paused": agv.paused,
        "operatingMode": "MANUAL" if "manual" in faults else "AUTOMATIC",
        "errors": [*agv.errors, *([FATAL] if "fatal" in faults else [])],
        "loads": [{"loadId": "load"}] if agv.loaded else [],
    }
    stop = "MANUAL" if "e_stop" in faults else "NONE"
    if version == "3.0":
        return body | _of_3(agv, doing, faults, stop)
    return body | _of_2(agv, doing, faults, stop)


FATAL = {"errorType": "driveError", "errorLevel": "FATAL", "errorReferences": []}


def _of_2(agv: Vehicle, doing: Iterable[RunningAction], faults: Collection[str], stop: str) -> dict[str, Any]:
    return {
        "actionStates": [_action(each, "resultDescription") for each in doing],
        "batteryState": {"batteryCharge": agv.battery, "charging": agv.charging},
        "safetyState": {"eStop": stop, "fieldViolation": False},
        "agvPosition": {**_place(agv), "positionInitialized": "lost" not in faults},
    }


def _of_3(agv: Vehicle, doing: Iterable[RunningAction], faults: Collection[str], stop: str) -> dict[str, Any]:
    instant = [each for each in doing if each.instant]
    return {
        "actionStates": [_action(each, "actionResult") for each in doing if not each.instant],
        "instantActionStates": [_action(each, "actionResult") for each in instant],
        "powerSupply": {"stateOfCharge": agv.battery, "charging": agv.charging},
        "safetyState": {"activeEmergencyStop": stop, "fieldViolation": False},
        "mobileRobotPosition": {**_place(agv), "localized": "lost" not in faults},
    }


def _place(agv: Vehicle) -> dict[str, Any]:
    x, y = agv.at or (0.0, 0.0)
    return {"x": x, "y": y, "theta": 0.0, "mapId": "map"}


def _action(doing: RunningAction, result: str) -> dict[str, Any]:
    row = {"actionId": doing.id, "actionType": doing.type, "actionStatus": doing.status}
    return row if doing.result is None else {**row, result: doing.result}


def _part(steps: Iterable[Mapping[str, Any]], keys: Iterable[str]) -> list[dict[str, Any]]:
    return [{key: step[key] for key in keys} for step in steps]
