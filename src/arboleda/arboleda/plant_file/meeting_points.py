"""Check of targets: two of one robot at one place, and places at which two arms can meet without a zone."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from arboleda.dashboard.twin import bodies, kinematics
from arboleda.dashboard.twin.kinematics import Point
from arboleda.kinds.arm import Arm
from arboleda.model.errors import ArboledaError
from arboleda.model.plant_model import Cell, PlantModel, Pose, Workspace

from .urdf import drawn_arm, robot_urdf

MEETING_M = 0.010  # two tools that come so near to each other meet
MOST_NAMED = 3  # pairs of targets in one sentence


@dataclass(frozen=True, kw_only=True)
class ToolPoint:
    """Place of an arm's tool at a target, m."""

    pose: Pose
    at: Point


def warnings(plant: PlantModel) -> tuple[str, ...]:
    """The targets that are one place, and those at which two arms can meet."""
    alike = [each for cell in plant.cells for space in cell.spaces for each in _alike(cell, space)]
    try:
        return (*alike, *_meetings(plant))
    except ArboledaError as error:
        return (*alike, f"nobody has looked where arms can meet: {error}")


def _alike(cell: Cell, space: Workspace) -> Iterator[str]:
    """The targets of a robot that it cannot tell apart; ends of paths, and where those are met, may be so."""
    ends = {path.code for path in space.paths}
    met = () if cell.handover is None else (*cell.handover.targets, *cell.groups.get("pickups", ()))
    targets = {name: pose for name, pose in space.targets.items() if name not in ends.union(met)}
    for (one, here), (other, there) in combinations(targets.items(), 2):
        is_same = space.robot.motion.stands_at(here.q, there.q) and here.above == there.above
        if is_same and space.home not in (here, there):
            yield f"{cell.name}: {one} and {other} of {space.robot.name} are one place"


def _meetings(plant: PlantModel) -> Iterator[str]:
    spaces = [(cell, space) for cell in plant.cells for space in cell.spaces]
    arms = [(cell, space, arm) for cell, space in spaces if (arm := drawn_arm(space.robot)) is not None]
    points = [_points(plant, space, arm) for _, space, arm in arms]
    for (one, other), (its, others) in zip(combinations(arms, 2), combinations(points, 2), strict=True):
        if one[2].name == other[2].name or one[2].base == other[2].base:
            continue  # one arm that cells share; or their places are not declared
        near = list(_near(its, others))
        if near:
            yield _sentence(one[:2], other[:2], near)


def _points(plant: PlantModel, space: Workspace, arm: Arm) -> list[ToolPoint]:
    body = bodies.read(robot_urdf(plant, arm.name))
    frame = kinematics.floor((arm.base.x, arm.base.y, arm.base.yaw))
    return [
        ToolPoint(pose=pose, at=kinematics.at(kinematics.tool(body, pose.joints, frame)))
        for pose in space.poses
    ]


def _near(its: Sequence[ToolPoint], others: Sequence[ToolPoint]) -> Iterator[tuple[Pose, Pose, float]]:
    """The targets at which the tools would be near each other, and that have no zone in common."""
    for one in its:
        for other in others:
            apart = math.dist(one.at, other.at)
            if apart <= MEETING_M and not one.pose.zones & other.pose.zones:
                yield one.pose, other.pose, apart


def _sentence(
    one: tuple[Cell, Workspace], other: tuple[Cell, Workspace], near: Sequence[tuple[Pose, Pose, float]]
) -> str:
    (cell, space), (_, further) = one, other
    pairs = [f"{a.name} and {b.name} ({apart * 1000:.0f} mm apart)" for a, b, apart in near[:MOST_NAMED]]
    more = "" if len(near) <= MOST_NAMED else f" and {len(near) - MOST_NAMED} more"
    arms = f"{space.robot.name} and {further.robot.name}"
    return f"{cell.name}: {arms} can meet at {', '.join(pairs)}{more}, which no zone has in common"
