"""Order that a virtual vehicle carries out: its steps, and the updates that fit it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

Said = Mapping[str, Any]
NO_ROUTE, ORDER, UPDATE = "noRouteError", "orderError", "orderUpdateError"


@dataclass(kw_only=True)
class Course:
    """Nodes and edges still before the vehicle, by their sequence ids; the first is the next."""

    id: str = ""
    update: int = 0
    steps: list[Said] = field(default_factory=list)

    @property
    def nodes(self) -> list[Said]:
        return [step for step in self.steps if "nodeId" in step]

    @property
    def edges(self) -> list[Said]:
        return [step for step in self.steps if "edgeId" in step]

    def objection(self, said: Said, node: str) -> str | None:
        """The reason why a vehicle at that node cannot take an order; None if it can."""
        if [step["sequenceId"] for step in _steps(said)] != list(_numbers(said)):
            return ORDER
        if said["orderId"] == self.id and self.id:
            return None if self._continues(said) else UPDATE
        if self.steps:
            return ORDER
        return None if said["nodes"][0]["nodeId"] == node or not node else NO_ROUTE

    def take(self, said: Said) -> None:
        """Begin an order, or go on with its update; the first node is where the vehicle or its base ends."""
        if said["orderId"] == self.id and self.steps:
            first = said["nodes"][0]["sequenceId"]
            kept = [step for step in self.steps if step["sequenceId"] <= first]
            self.steps = kept + [step for step in _steps(said) if step["sequenceId"] > first]
        else:
            self.steps = _steps(said) if said["orderId"] != self.id else _steps(said)[1:]
        self.id, self.update = said["orderId"], said["orderUpdateId"]

    def _continues(self, said: Said) -> bool:
        return bool(said["orderUpdateId"] > self.update)


def _steps(said: Said) -> list[Said]:
    return sorted([*said["nodes"], *said["edges"]], key=lambda step: step["sequenceId"])


def _numbers(said: Said) -> range:
    first = min((node["sequenceId"] for node in said["nodes"]), default=0)
    return range(first, first + len(said["nodes"]) + len(said["edges"]))
