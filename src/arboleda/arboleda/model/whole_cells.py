"""Cell of a robot as its board sees it: with the places of all cells that share the robot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from .plant_model import Cell, Crossing, PlantModel, Pose, Workspace


def whole_cell(model: PlantModel, robot: str) -> Cell:
    """The first cell of a robot, where that has one workspace for all its cells."""
    cells = [cell for cell in model.cells_of[robot] if robot in cell.reach]
    if len(cells) < 2:
        return model.cell_of[robot]
    others = [space for space in cells[0].spaces if space.robot.name != robot]
    return replace(cells[0], spaces=(*others, _joined(robot, cells)))


def _joined(robot: str, cells: Sequence[Cell]) -> Workspace:
    """The workspace in the first cell, with the poses of the other cells, each under the name of its cell."""
    first, *others = [cell.reach[robot] for cell in cells]
    named = [(cell.name, space) for cell, space in zip(cells[1:], others, strict=True)]
    poses = [_named(name, space, pose) for name, space in named for pose in space.poses]
    crossings = [
        Crossing(a=_name(name, space, each.a), b=_name(name, space, each.b), zones=each.zones)
        for name, space in named
        for each in space.crossings
    ]
    more = tuple(pose for pose in poses if pose.name != first.home.name)
    return replace(
        first,
        poses=(*first.poses, *more),
        target_names=(),
        crossings=(*first.crossings, *crossings),
        supplies=(),
    )


def _named(cell: str, space: Workspace, pose: Pose) -> Pose:
    return replace(pose, name=_name(cell, space, pose.name))


def _name(cell: str, space: Workspace, pose: str) -> str:
    return pose if pose == space.home.name else f"{cell} {pose}"
