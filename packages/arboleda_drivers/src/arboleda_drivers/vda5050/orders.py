"""Messages to a vehicle: orders, sent part by part, and instant actions."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from arboleda.drivers import Command, Facts, FollowPath

from .state import ENDS_ORDER, VehicleState

Place = Callable[[str], tuple[float, float] | None]
"""The position of a node on the vehicle's map, m; None if unknown."""


@dataclass(frozen=True, kw_only=True)
class Action:
    """Action of a vehicle at a node, or at once."""

    id: str
    type: str
    values: tuple[tuple[str, Any], ...] = ()
    blocking: str = "HARD"

    def message(self) -> dict[str, Any]:
        return {
            "actionId": self.id,
            "actionType": self.type,
            "blockingType": self.blocking,
            "actionParameters": [{"key": key, "value": value} for key, value in self.values],
        }


class Actions:
    """Actions of one start of the plant, whose `mark` sets their ids apart from those of any other."""

    def __init__(self, mark: str) -> None:
        self._mark, self._count = mark, 0

    def new(self, blocking: str, verb: str, values: Facts) -> Action:
        """The action of a verb: `startCharging` for `start_charging`, its values as parameters so named."""
        parameters = tuple((as_the_standard_writes(name), value) for name, value in values)
        return self._of(as_the_standard_writes(verb), parameters, blocking)

    def of_types(self, *types: str) -> list[Action]:
        return [self._of(type, (), "NONE") for type in types]

    def _of(self, type: str, values: tuple[tuple[str, Any], ...], blocking: str) -> Action:
        self._count += 1
        return Action(id=f"{self._mark}-a{self._count}", type=type, values=values, blocking=blocking)


@dataclass(kw_only=True)
class Order:
    """A command that the vehicle is at: its nodes, of which the first `released` may be driven to.

    The node number i of the way has the sequence id 2 i, the edge after it 2 i + 1.
    """

    id: str
    command: Command
    nodes: tuple[str, ...]
    released: int
    actions: tuple[Action, ...] = ()  # at the last node
    passing: Mapping[int, tuple[Action, ...]] = field(default_factory=dict)  # on edges, by the node before
    update: int = 0
    taken: bool = False  # the vehicle has named it in a state
    cancelled: bool = False

    @property
    def all_actions(self) -> tuple[Action, ...]:
        return (*self.actions, *(action for actions in self.passing.values() for action in actions))

    @property
    def last_sequence(self) -> int:
        return 2 * (len(self.nodes) - 1)

    def extend(self, node: str, sequence: int, base: int) -> int | None:
        """Release `base` nodes ahead of one reached; returns the begin of the update, None without one."""
        step, between = divmod(sequence, 2)
        if between or not 0 <= step < self.released or self.nodes[step] != node:
            return None
        released = min(len(self.nodes), step + 1 + base)
        if base == 0 or released <= self.released:
            return None
        first, self.released, self.update = self.released - 1, released, self.update + 1
        return first

    def failure(self, state: VehicleState, *, is_known: bool) -> str | None:
        """The word for the reason why the vehicle will not finish it; None if it will.

        `is_known`: the plant knows the node where the vehicle is.
        """
        if state.hindrance is not None:
            return state.hindrance
        for trouble in state.troubles:
            refused = state.update < self.update and self.id in dict(trouble.about).values()
            if trouble.level in ENDS_ORDER or refused:
                return trouble.word
        for action in self.all_actions:
            found = state.actions.get(action.id)
            if found is not None and found.status == "FAILED":
                return state.trouble_with(action.id) or f"{action.type}_failed"
        if state.ahead or state.driving or state.update < self.update:
            return None
        return self._missing(state, is_known=is_known)

    def _missing(self, state: VehicleState, *, is_known: bool) -> str | None:
        """The word for the part of it that a vehicle with nothing ahead has not done; None for none."""
        if self.released < len(self.nodes):
            return "ended_at_its_base"
        if state.node == self.nodes[-1]:
            return None if state.sequence == self.last_sequence else "ended_on_its_way"
        return None if isinstance(self.command, FollowPath) and is_known else f"at_node_{state.node}"

    def is_done(self, state: VehicleState) -> bool:
        """True if the vehicle has ended it; the plant itself compares place and facts."""
        return (
            not state.ahead
            and not state.driving
            and state.update >= self.update
            and all(state.is_over(action.id) for action in self.all_actions)
        )

    def message(
        self, place: Place, map: str, first: int = 0, most_nodes: int | None = None
    ) -> dict[str, Any]:
        """The message of the order from a node on; an update begins where the base ended."""
        steps = range(first, len(self.nodes))[:most_nodes]
        return {
            "orderId": self.id,
            "orderUpdateId": self.update,
            "nodes": [self._node(step, place, map) for step in steps],
            "edges": [self._edge(step) for step in steps[:-1]],
        }

    def _node(self, step: int, place: Place, map: str) -> dict[str, Any]:
        name = self.nodes[step]
        at = place(name)
        last = step == len(self.nodes) - 1
        position = {} if at is None else {"nodePosition": {"x": at[0], "y": at[1], "mapId": map}}
        return {
            "nodeId": name,
            "sequenceId": 2 * step,
            "released": step < self.released,
            **position,
            "actions": [action.message() for action in self.actions] if last else [],
        }

    def _edge(self, step: int) -> dict[str, Any]:
        start, end = self.nodes[step : step + 2]
        return {
            "edgeId": edge_id(start, end),
            "sequenceId": 2 * step + 1,
            "released": step + 1 < self.released,
            "startNodeId": start,
            "endNodeId": end,
            "actions": [action.message() for action in self.passing.get(step, ())],
        }


def edge_id(start: str, end: str) -> str:
    """The name of an edge, by its nodes."""
    return f"{start}_{end}"


def as_the_standard_writes(name: str) -> str:
    """The name as the standard writes it: `startCharging` for `start_charging`."""
    first, *others = name.split("_")
    return first + "".join(map(str.capitalize, others))


def instant(actions: Sequence[Action], version: str) -> dict[str, Any]:
    """The message of instant actions; for 2.0 under two keys, as its vehicles read one or the other."""
    messages = [action.message() for action in actions]
    return {"actions": messages, **({"instantActions": messages} if version == "2.0" else {})}
