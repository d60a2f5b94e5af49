"""Offers of a plant: recipes of cells, promises for a task, the level of assistants."""

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
class AssistantLevel:
    """Level of assistants, `assistants` of the plant file."""

    level: Annotated[
        Literal["off", "read", "propose", "submit"],
        "off: nothing. read: look, and stop. propose, submit: the same and more.",
    ]
    cells: Annotated[list[str], "Those to which they may give tasks."]
    at_once: Annotated[int, "How many of their tasks may be open."]
    hours: Annotated[str | None, "The hours of the day in which they may; null: at any time."]
