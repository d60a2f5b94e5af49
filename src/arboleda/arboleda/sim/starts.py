"""Starts of virtual robots: where each stands at first, and where parts lie ready for it."""

from __future__ import annotations

from arboleda.model.commands import Position
from arboleda.model.plant_model import Cell, Pose


def start_of(cell: Cell, robot: str) -> Position | None:
    """The position of a virtual robot at first; None for one that has no place."""
    space = cell.reach.get(robot)
    return space.home.q if space else None


def supplies_of(cell: Cell, robot: str) -> tuple[Pose, ...]:
    """The poses at which parts lie ready for a virtual robot."""
    space = cell.reach.get(robot)
    if space is None or not space.supplies:
        return space.poses if space else ()
    return tuple(space.by_name[name] for name in space.supplies)
