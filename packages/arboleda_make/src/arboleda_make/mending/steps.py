"""Steps that the devices of a cell can do, as they are written in a recipe."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from arboleda.drivers import Effect, Robot, Slot, Value, shown
from arboleda.model.plant_model import Cell

from .clues import Clues

BEFORE = ("which needs", "needs ", "has to be", "was not free", "no part to work on")
"""Words of findings that a step before the one that they name may mend."""
FEW = 3  # values of a parameter that are all tried


@dataclass(frozen=True, kw_only=True)
class KnownStep:
    """Step of the device in a role; `arguments` is the text between its parentheses, `values` the same where
    they are known.
    """

    role: str
    verb: str
    arguments: str = ""
    values: tuple[tuple[str, Value], ...] = ()
    score: int = 0
    handles: bool = False  # takes hold of a part, or lets go of it

    @property
    def words(self) -> str:
        return f"{self.role}.{self.verb}({self.arguments})"


def steps_of(cell: Cell, clues: Clues, text: str) -> list[KnownStep]:
    """The steps of a cell's devices, those that findings speak of first; `text`: of recipes, which has
    arguments that are in use.
    """
    found = [step for role, device in cell.members for step in _of(role, device, clues, text)]
    return sorted(found, key=lambda step: -step.score)


def _of(role: str, robot: Robot, clues: Clues, text: str) -> Iterator[KnownStep]:
    named = 2 * min(1, clues.count({role, robot.name}))
    if robot.verb_names:
        return _of_verbs(role, robot, clues, text, named)
    return _of_robot(role, robot, clues, named)


def _of_robot(role: str, robot: Robot, clues: Clues, named: int) -> Iterator[KnownStep]:
    if robot.joints or robot.floor_grid:
        yield KnownStep(role=role, verb="home", score=named)
    if robot.held_fact:
        handled = named + clues.says(" part", "holds")
        for verb in ("let_go", "grip"):
            yield KnownStep(role=role, verb=verb, score=handled, handles=True)


def _of_verbs(role: str, device: Any, clues: Clues, text: str, named: int) -> Iterator[KnownStep]:
    for verb in [each for each in device.kind.verbs.values() if each.effect is not Effect.QUERY]:
        for values in _values(verb):
            sets = dict(verb.sets_with(values)) if _is_certain(verb, values) else {}
            facts = clues.count(sets) + clues.count({str(word) for word in sets.values()})
            flags = any(type(value) is bool and _is_in_text(value, clues) for value in sets.values())
            for arguments in _arguments(verb, values, text):
                yield KnownStep(
                    role=role,
                    verb=verb.name,
                    arguments=arguments,
                    values=tuple(values.items()) if len(values) == len(verb.parameters) else (),
                    score=named + facts + flags + (verb.holds and clues.says(" part", "holds")),
                    handles=verb.holds,
                )


def _is_in_text(value: bool, clues: Clues) -> bool:
    return shown(value) in clues.text.replace(",", " ").split()


def _values(verb: Any) -> Iterator[dict[str, Value]]:
    """Values for those parameters that have a few."""
    rows = [
        [(name, word) for word in ((True, False) if type.type is bool else type.words)]
        for name, type in verb.parameters
        if type.type is bool or 0 < len(type.words) <= FEW
    ]
    yield from (dict(row) for row in itertools.product(*rows))


def _is_certain(verb: Any, values: dict[str, Value]) -> bool:
    """True where these values alone say what a verb sets."""
    if len(values) == len(verb.parameters):
        return True
    slots = {value.name for _, value in verb.sets if isinstance(value, Slot)}
    return verb.sets_by is None and slots <= values.keys()


def _arguments(verb: Any, values: dict[str, Value], text: str) -> Sequence[str]:
    """Arguments with these values; where others are needed, as the text has them elsewhere."""
    if len(values) == len(verb.parameters):
        return [", ".join(f"{name}={value!r}" for name, value in values.items())]
    used = re.findall(rf"\.{verb.name}\(([^()]*)\)", text)
    return list(dict.fromkeys(used))[:FEW]
