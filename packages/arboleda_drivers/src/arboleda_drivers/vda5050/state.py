"""State of a vehicle as it reports it, the same for all versions of VDA 5050."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from arboleda.drivers import Value

Body = Mapping[str, Any]
"""A message that fits the schema of its topic."""
BROKEN = frozenset({"FATAL"})  # levels of errors with which a vehicle takes no order
ENDS_ORDER = frozenset({"FATAL", "CRITICAL"})
OVER = frozenset({"FINISHED", "FAILED"})
HELD_BY_HAND = frozenset({"MANUAL", "REMOTE"})  # other stops end by themselves
DRIVES_BY_ORDER = frozenset({"AUTOMATIC", "SEMIAUTOMATIC"})


@dataclass(frozen=True, kw_only=True)
class Trouble:
    """Error reported by a vehicle; `about` are the values that it names, by their types."""

    word: str
    level: str
    about: tuple[tuple[str, str], ...]

    def names(self, key: str, value: str) -> bool:
        return (key, value) in self.about


@dataclass(frozen=True, kw_only=True)
class ActionState:
    """Progress of an action; `result` is its answer, if it has one."""

    status: str
    result: str | None


@dataclass(frozen=True, kw_only=True)
class VehicleState:
    """State of a vehicle; `ahead` is the number of nodes and edges of its order still before it."""

    header: int
    timestamp: str
    order: str
    update: int
    node: str
    sequence: int
    ahead: int
    driving: bool
    paused: bool | None
    homed: bool
    mode: str
    stop: str
    actions: Mapping[str, ActionState]
    troubles: tuple[Trouble, ...]
    loaded: bool | None
    charging: bool
    battery: float

    @property
    def hindrance(self) -> str | None:
        """The word for the reason why it takes no order at all; None if it takes orders."""
        if self.stop in HELD_BY_HAND:
            return f"stop_{self.stop}"
        if self.mode not in DRIVES_BY_ORDER:
            return f"mode_{self.mode}"
        return next((each.word for each in self.troubles if each.level in BROKEN), None)

    def trouble_with(self, id: str) -> str | None:
        """The word for an error that names this order or action; None for none."""
        return next((each.word for each in self.troubles if id in dict(each.about).values()), None)

    def is_over(self, action: str) -> bool:
        found = self.actions.get(action)
        return found is not None and found.status in OVER


FACTS: dict[str, Callable[[VehicleState], Value | None]] = {
    "loaded": lambda state: state.loaded,
    "charging": lambda state: state.charging,
    "battery": lambda state: state.battery,
}
"""The facts that a declared kind may have."""


def read(body: Body) -> VehicleState:
    """The state in a message that fits the schema of its version."""
    power = body.get("batteryState") or body.get("powerSupply") or {}
    position = body.get("agvPosition") or body.get("mobileRobotPosition")
    safety, loads = body["safetyState"], body.get("loads")
    actions = [*body["actionStates"], *body.get("instantActionStates", ())]
    return VehicleState(
        header=body["headerId"],
        timestamp=body["timestamp"],
        order=body["orderId"],
        update=body["orderUpdateId"],
        node=body["lastNodeId"],
        sequence=body["lastNodeSequenceId"],
        ahead=len(body["nodeStates"]) + len(body["edgeStates"]),
        driving=body["driving"],
        paused=body.get("paused"),
        homed=_homed(position, body["lastNodeId"]),
        mode=body["operatingMode"],
        stop=safety.get("eStop") or safety.get("activeEmergencyStop", "NONE"),
        actions={each["actionId"]: _action(each) for each in actions},
        troubles=tuple(map(_trouble, body["errors"])),
        loaded=None if loads is None else len(loads) > 0,
        charging=power.get("charging", False),
        battery=float(power.get("batteryCharge", power.get("stateOfCharge", 0.0))),
    )


def _homed(position: Body | None, node: str) -> bool:
    if position is None:
        return node != ""
    return bool(position.get("positionInitialized", position.get("localized", False)))


def _action(body: Body) -> ActionState:
    return ActionState(
        status=body["actionStatus"], result=body.get("resultDescription") or body.get("actionResult")
    )


def _trouble(body: Body) -> Trouble:
    about = tuple((each["referenceKey"], each["referenceValue"]) for each in body.get("errorReferences", ()))
    return Trouble(word=body["errorType"], level=body["errorLevel"], about=about)
