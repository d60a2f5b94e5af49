"""Check of targets: two of one robot at one place, and places at which two robots can meet without a zone."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from arboleda.geometry import bodies, kinematics
from arboleda.geometry.kinematics import Point
from arboleda.kinds.arm import Arm
from arboleda.model.errors import ArboledaError
from arboleda.model.plant_model import Cell, PlantModel, Pose, Workspace

from .grid_check import on_floor
from .urdf import drawn_arm, robot_urdf

MEETING_M = 0.010  # two tools that come so near to each other meet
MOST_NAMED = 3  # pairs of targets in one sentence


@dataclass(frozen=True, kw_only=True)
class ToolPoint:
    """Position of an arm's tool at a target, m; for a mobile robot, of the node, at height 0."""

    pose: Pose
    at: Point


@dataclass(frozen=True, kw_only=True)
class Placed:
    """Robot of a cell whose place is declared, with its points; `drives`: the robot is on a grid."""

    cell: Cell
    space: Workspace
    points: list[ToolPoint]
    drives: bool

    def meets_on_purpose(self, other: Placed) -> bool:
        """True for an arm and a mobile robot of one cell: they hand over parts where there is no zone."""
        return self.cell is other.cell and self.drives != other.drives


def warnings(plant: PlantModel) -> tuple[str, ...]:
    """The targets that are one place, and those at which two robots can meet."""
    alike = [each for cell in plant.cells for space in cell.spaces for each in _alike(cell, space)]
    try:
        return (*alike, *_meetings(plant))
    except ArboledaError as error:
        return (*alike, f"nobody has looked where robots can meet: {error}")


def _alike(cell: Cell, space: Workspace) -> Iterator[str]:
    """The pairs of targets of a robot that it cannot tell apart.

    Ends of paths may be alike, and so may two targets at which parts are handed over.
    """
    ends = {path.code for path in space.paths}
    met = set() if cell.handover is None else {*cell.handover.targets, *cell.groups.get("pickups", ())}
    names = {pose.name: name for name, pose in reversed(space.targets.items()) if name not in ends}
    targets = [(names[pose.name], pose) for pose in space.poses if pose.name in names]
    for (one, here), (other, there) in combinations(targets, 2):
        is_same = space.robot.motion.stands_at(here.q, there.q) and here.above == there.above
        if is_same and space.home not in (here, there) and not met.issuperset((one, other)):
            yield f"{cell.name}: {one} and {other} of {space.robot.name} are one place"


def _meetings(plant: PlantModel) -> Iterator[str]:
    """Meetings of arms with each other, and with mobile robots; `grid_check` has those of mobile robots."""
    placed = [each for cell in plant.cells for space in cell.spaces for each in _placed(plant, cell, space)]
    for one, other in combinations(placed, 2):
        if one.space.robot.name == other.space.robot.name or (one.drives and other.drives):
            continue
        if near := list(_near(one, other)):
            yield _sentence(one, other, near)


def _placed(plant: PlantModel, cell: Cell, space: Workspace) -> Iterator[Placed]:
    """The robot of a workspace; nothing where the plant file does not say where the robot stands."""
    arm, grid = drawn_arm(space.robot), space.robot.floor_grid
    if arm is not None and arm.base.is_declared:
        yield Placed(cell=cell, space=space, points=_points(plant, space, arm), drives=False)
    elif grid is not None and grid.origin.is_declared:
        points = [ToolPoint(pose=pose, at=(*on_floor(grid, pose), 0.0)) for pose in space.poses]
        yield Placed(cell=cell, space=space, points=points, drives=True)


def _points(plant: PlantModel, space: Workspace, arm: Arm) -> list[ToolPoint]:
    body = bodies.read(robot_urdf(plant, arm.name))
    frame = kinematics.floor((arm.base.x, arm.base.y, arm.base.yaw))
    return [
        ToolPoint(pose=pose, at=kinematics.at(kinematics.tool(body, pose.joints, frame)))
        for pose in space.poses
    ]


def _near(one: Placed, other: Placed) -> Iterator[tuple[Pose, Pose, float]]:
    """The pairs of poses at which two robots would be near each other without a common zone, and how near."""
    axes = 2 if one.drives or other.drives else 3
    for its in one.points:
        for others in other.points:
            apart = math.dist(its.at[:axes], others.at[:axes])
            zones = (its.pose.zones, others.pose.zones)
            is_wanted = one.meets_on_purpose(other) and not any(zones)
            if apart <= MEETING_M and not zones[0] & zones[1] and not is_wanted:
                yield its.pose, others.pose, apart


def _sentence(one: Placed, other: Placed, near: Sequence[tuple[Pose, Pose, float]]) -> str:
    pairs = [f"{a.name} and {b.name} ({apart * 1000:.0f} mm apart)" for a, b, apart in near[:MOST_NAMED]]
    more = "" if len(near) <= MOST_NAMED else f" and {len(near) - MOST_NAMED} more"
    robots = f"{one.space.robot.name} and {other.space.robot.name}"
    return f"{one.cell.name}: {robots} can meet at {', '.join(pairs)}{more}, which no zone has in common"
