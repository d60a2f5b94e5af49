"""Teaching of a cell as the web server sees it: devices, buttons that are held, targets made of that."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol

from arboleda.drivers import Value
from arboleda.extension import ArboledaError

State = dict[str, Any]
Spot = Sequence[float] | int
"""A position as people write it: degrees or millimetres of each joint, or a node."""
Frame = Literal["base", "tool"]


class TeachRefused(ArboledaError):
    """Nothing moves, or no target is made; the sentence says why."""


@dataclass(frozen=True, kw_only=True)
class Along:
    """Way of a tool along an axis of the robot's base or of the tool itself: `mm` of it, else on and on."""

    axis: Literal["x", "y", "z"]
    frame: Frame = "base"
    sign: Literal[-1, 1] = 1
    mm: float | None = None


@dataclass(frozen=True, kw_only=True)
class Button:
    """Button of a teacher: a goal, a way along an axis, or a verb with its values; exactly one of them.

    `session` is the number of the act that began the teaching, `number` counts the presses in it.
    """

    session: int
    number: int
    robot: str
    held: bool = True
    goal: Spot | None = None
    along: Along | None = None
    verb: str = ""
    values: Mapping[str, Value] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Target:
    """Target to be made, or moved, where a robot stands; a `zone` in which it lies is one of the plant file.

    Without `approach_mm` the one that it has stays; `editor` and `name` are those of the draft.
    """

    robot: str
    target: str
    editor: str
    name: str
    approach_mm: float | None = None
    zone: str = ""


class TeachApi(Protocol):
    """Teaching of the cells of one plant; all data is plain, TeachRefused where it cannot be."""

    @abstractmethod
    def state(self, cell: str) -> State:
        """Teacher, why nobody may begin now, the devices with their commands, the targets and the zones."""

    @abstractmethod
    def press(self, cell: str, button: Button) -> State:
        """A button is held, or let go of: `teaching` of the cell, and where the robot stands."""

    @abstractmethod
    def here(self, cell: str, target: Target) -> State:
        """A target in the draft where a robot stands now: `at`, and the place in the plant file."""
