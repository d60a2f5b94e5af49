"""Order that a virtual vehicle carries out: its steps and actions, and the updates that fit it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

Body = Mapping[str, Any]
ACTION_S = 1.0
NO_ROUTE, ORDER, UPDATE = "noRouteError", "orderError", "orderUpdateError"


@dataclass(kw_only=True)
class RunningAction:
    """Action and its progress."""

    id: str
    type: str
    status: str = "WAITING"
    result: str | None = None
    instant: bool = False
    blocks: bool = True
    left_s: float = ACTION_S
    values: Mapping[str, Any] = field(default_factory=dict)


@dataclass(kw_only=True)
class Course:
    """Nodes and edges still before the vehicle, by their sequence ids; the first is the next."""

    id: str = ""
    update: int = 0
    steps: list[Body] = field(default_factory=list)

    @property
    def nodes(self) -> list[Body]:
        return [step for step in self.steps if "nodeId" in step]

    @property
    def edges(self) -> list[Body]:
        return [step for step in self.steps if "edgeId" in step]

    def objection(self, body: Body, node: str) -> str | None:
        """The reason why a vehicle at that node cannot take an order; None if it can."""
        if [step["sequenceId"] for step in _steps(body)] != list(_numbers(body)):
            return ORDER
        if body["orderId"] == self.id and self.id:
            return None if self._continues(body) else UPDATE
        if self.steps:
            return ORDER
        return None if body["nodes"][0]["nodeId"] == node or not node else NO_ROUTE

    def take(self, body: Body) -> None:
        """Begin an order, or go on with its update; the first node is where the vehicle or its base ends."""
        if body["orderId"] == self.id and self.steps:
            first = body["nodes"][0]["sequenceId"]
            kept = [step for step in self.steps if step["sequenceId"] <= first]
            self.steps = kept + [step for step in _steps(body) if step["sequenceId"] > first]
        else:
            self.steps = _steps(body) if body["orderId"] != self.id else _steps(body)[1:]
        self.id, self.update = body["orderId"], body["orderUpdateId"]

    def _continues(self, body: Body) -> bool:
        return bool(body["orderUpdateId"] > self.update)


def _steps(body: Body) -> list[Body]:
    return sorted([*body["nodes"], *body["edges"]], key=lambda step: step["sequenceId"])


def _numbers(body: Body) -> range:
    first = min((node["sequenceId"] for node in body["nodes"]), default=0)
    return range(first, first + len(body["nodes"]) + len(body["edges"]))
