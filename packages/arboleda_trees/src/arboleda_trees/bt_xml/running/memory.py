"""Variables of a tree: each subtree has its own, and sees some of the tree around it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from arboleda_trees.bt_xml.values import OUTER, PRIVATE

Value = float | int | str


@dataclass(eq=False)
class Scope:
    """Variables of one tree.

    `names` has by its name here each variable that is one of the tree around this one. With `shares` all
    variables are, except private ones and those with a value here. `changes` counts how often each variable
    was set, if a node asks for that.
    """

    around: Scope | None = None
    names: Mapping[str, str] = field(default_factory=dict)
    shares: bool = False
    values: dict[str, Value] = field(default_factory=dict)
    changes: dict[str, int] = field(default_factory=dict)
    is_watched: bool = False

    def place(self, name: str) -> tuple[Scope, str]:
        """The scope that holds a variable, and its name there."""
        scope: Scope = self
        while True:
            if name.startswith(OUTER):
                while scope.around is not None:
                    scope = scope.around
                return scope, name.removeprefix(OUTER)
            around = scope.around
            if around is None or name in scope.values:
                return scope, name
            if name in scope.names:
                scope, name = around, scope.names[name]
            elif scope.shares and not name.startswith(PRIVATE):
                scope = around
            else:
                return scope, name

    def get(self, name: str) -> Value | None:
        """The value of a variable; None if it has none."""
        scope, key = self.place(name)
        return scope.values.get(key)

    def set(self, name: str, value: Value) -> None:
        scope, key = self.place(name)
        scope.changes[key] = scope.changed(key) + 1
        scope.values[key] = value

    def changed(self, key: str) -> int:
        """The number of times that a variable of this tree was set; 0 if it has no value."""
        return self.changes.get(key, 1) if key in self.values else 0

    def watch(self, name: str) -> int:
        """The number of times that a variable was set; from now on it is counted and kept."""
        scope, key = self.place(name)
        scope.is_watched = True
        return scope.changed(key)

    def kept(self) -> dict[str, Any] | None:
        """The state to keep for the next start; None if there are no variables."""
        if not self.values:
            return None
        return {"values": self.values, **({"changes": self.changes} if self.is_watched else {})}

    def restore(self, state: Mapping[str, Any]) -> None:
        self.values.update(state["values"])
        self.changes.update(state.get("changes", {}))
        self.is_watched = "changes" in state

    def unset(self, name: str) -> None:
        scope, key = self.place(name)
        scope.values.pop(key, None)
        scope.changes.pop(key, None)
