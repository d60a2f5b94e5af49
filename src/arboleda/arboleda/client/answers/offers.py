"""Offers of a plant: recipes of cells, promises for a task, OEE, the level of assistants, faults."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Literal


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """Parameter of a recipe; more types may be added."""

    name: str
    called: Annotated[str, "Its name for people."]
    type: Annotated[str, "`choice`: one of its `choices`; `integer`, `number`: within its limits."]
    choices: list[str]
    lower: float | None = None
    upper: float | None = None


@dataclass(frozen=True, kw_only=True)
class Recipe:
    """Recipe that a cell offers."""

    name: str
    about: Annotated[str, "What it does, in a line."]
    default: Annotated[bool, "A task that names no recipe means this one."]
    form: Annotated[str, "How its task text is written."] = field(
        metadata={"examples": ["<cell> <path> <station>"]}
    )
    example: str = field(metadata={"examples": ["sis_a 0A 8"]})
    parameters: list[Parameter]


@dataclass(frozen=True, kw_only=True)
class Offer:
    """Recipes of one cell."""

    cell: str
    recipes: list[Recipe]


@dataclass(frozen=True, kw_only=True)
class Promise:
    """Promise of a cell for a task that it has not been given."""

    cell: str
    text: Annotated[str, "The task for this cell."]
    seconds: Annotated[float, "Until it would have done it, as far as past tasks tell."]
    hindrance: Annotated[str | None, "Why it could not begin it now."]
    full: Annotated[bool, "Whether its queue has no room."]


@dataclass(frozen=True, kw_only=True)
class CellOee:
    """OEE of one cell; shares from 0 to 1, null where `missing` says why nobody can say."""

    cell: str
    since_s: Annotated[float, "Unix time; later than asked where nothing was kept before."]
    until_s: float
    planned_s: Annotated[float, "A task waited or was at work."]
    worked_s: Annotated[float, "Of that, the cell was at work."]
    done: int
    failed: int
    timed: Annotated[int, "Of these, tasks whose shortest time is known."]
    availability: float | None
    performance: float | None
    quality: float | None
    oee: Annotated[float | None, "The three of them multiplied."]
    missing: str | None


@dataclass(frozen=True, kw_only=True)
class AssistantLevel:
    """Level of assistants, `assistants` of the plant file."""

    level: Annotated[
        Literal["off", "read", "propose", "submit"],
        "off: nothing. read: look, and stop. propose, submit: the same and more.",
    ]
    cells: Annotated[list[str], "Those to which they may give tasks."]
    at_once: Annotated[int, "How many of their tasks may be open."]
    hours: Annotated[str | None, "The hours of the day in which they may; null: at any time."]


@dataclass(frozen=True, kw_only=True)
class FaultKind:
    """Fault that can be provoked at a virtual device."""

    robot: str
    kind: str
    about: str
    lasts: Annotated[bool, "False: it is over at once."]


@dataclass(frozen=True, kw_only=True)
class ProvokedFault:
    """Fault that was provoked, and goes on for so long."""

    number: int
    robot: str
    kind: str
    about: str
    left_s: Annotated[float, "For how long it goes on; 0.0: it was an instant."]


@dataclass(frozen=True, kw_only=True)
class FaultList:
    """Faults that go on, and those that can be provoked."""

    begun: Annotated[list[ProvokedFault], "Those that go on, the first one first."]
    offers: Annotated[list[FaultKind], "What can be provoked; empty where no device is virtual."]
