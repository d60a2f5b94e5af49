"""Notation of recipes: what a person writes in Python, or in a tree as XML, as an advice says it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from arboleda.kinds.declared import Slot
from arboleda.model.facts import Value, shown
from arboleda.model.plant_model import Cell, Robot
from arboleda.plant_file.declared_kinds import verbs_of


@dataclass(frozen=True, kw_only=True)
class Notation:
    """Notation of a recipe of one cell; `is_tree`: the recipe is a tree as XML."""

    cell: Cell
    is_tree: bool

    def states(self, what: str, value: Value) -> str:
        """The advice to state a fact, or a number of parts, of the end of a task."""
        stated = f'"{what}: {shown(value)}"' if self.is_tree else f'{{"{what}": {_quoted(value)}}}'
        metadata = f"<Metadata ends_with={stated}/>" if self.is_tree else f"ends_with={stated}"
        return f"; write {metadata} if that is meant"

    def home(self, robot: str) -> str:
        return self._call(robot, "home", {})

    def sets(self, device: str, fact: str, value: Value) -> str:
        """The command that sets a fact; empty where no verb does that alone."""
        robot = next(each for each in self.cell.robots if each.name == device)
        for verb in verbs_of(robot).values():
            wanted = dict(verb.sets).get(fact)
            parameters = [name for name, _ in verb.parameters]
            if isinstance(wanted, Slot) and parameters == [wanted.name]:
                return self._call(device, verb.name, {wanted.name: value})
            if wanted == value and not parameters:
                return self._call(device, verb.name, {})
        return ""

    def lets_go(self, device: Robot) -> str:
        """The command with which a device lets go of a part; empty where it has no such verb."""
        verbs = (each for each in verbs_of(device).values() if each.lets_go())
        return next((self._call(device.name, each.name, each.letting_go()) for each in verbs), "")

    def _call(self, device: str, word: str, values: Mapping[str, Value]) -> str:
        role = next(role for role, robot in self.cell.members if robot.name == device)
        if self.is_tree:
            ports = "".join(f' {name}="{shown(value)}"' for name, value in values.items())
            return f"<{role}_{word}{ports}/>"
        return f"{role}.{word}({', '.join(f'{name}={_quoted(value)}' for name, value in values.items())})"


def before(step: str) -> str:
    """The advice to do a step before; empty where nobody knows a step."""
    return f"; write {step} before" if step else ""


def _quoted(value: Value) -> str:
    return f'"{value}"' if isinstance(value, str) else repr(value)
