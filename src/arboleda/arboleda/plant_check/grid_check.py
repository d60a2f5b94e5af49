"""Check of grids: nodes in a zone that another robot may drive over although no target of it is there."""

from __future__ import annotations

import math
from collections.abc import Iterator

from arboleda.kinds.mobile.grid import Grid
from arboleda.model.plant_model import PlantModel, Pose, Workspace

MEETING_M = 0.010  # two nodes that are so near to each other are one place


def warnings(plant: PlantModel) -> tuple[str, ...]:
    """A sentence for each node in a zone that another robot may drive over outside the zone."""
    spaces = [space for cell in plant.cells for space in cell.spaces if space.robot.floor_grid is not None]
    return tuple(
        _sentence(one, pose, other, node)
        for one in spaces
        for pose in one.poses
        for other in spaces
        if pose.zones and other.robot.name != one.robot.name
        for node in _open_nodes(one, pose, other)
    )


def _sentence(one: Workspace, pose: Pose, other: Workspace, node: int) -> str:
    there = f"{one.robot.name} is at {pose.name} in {', '.join(sorted(pose.zones))}"
    name = other.robot.name
    how = f"a target of {name} at it, in that zone, does"
    return f"{there}, and nothing keeps {name} off its node {node} there; {how}"


def _open_nodes(one: Workspace, pose: Pose, other: Workspace) -> Iterator[int]:
    """The nodes of another robot at a pose in zones, if no pose of that robot there is in these zones."""
    place, grid = on_floor(one.robot.floor_grid, pose), other.robot.floor_grid
    for node in range(grid.size):
        guarded = any(each.q == node and each.zones & pose.zones for each in other.poses)
        if math.dist(place, grid.on_floor(node)) <= MEETING_M and not guarded:
            yield node


def on_floor(grid: Grid, pose: Pose) -> tuple[float, float]:
    """The place of a mobile robot's pose on the floor, m."""
    assert isinstance(pose.q, int)
    return grid.on_floor(pose.q)
