"""Check of targets: two of one robot at one place, and places at which two robots can meet without a zone."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from arboleda.geometry import bodies, kinematics
from arboleda.geometry.kinematics import Point
from arboleda.kinds.floor import Placement
from arboleda.model.errors import ArboledaError
from arboleda.model.plant_model import Cell, PlantModel, Pose, Robot, Workspace
from arboleda.plant_file.urdf import drawn_arm, robot_urdf
from arboleda.plant_file.yaml_flow import flow

from .grid_check import on_floor
from .layout_check import foot_m

MEETING_M = 0.060  # two tools that come so near to each other meet, with all that they hold
OVER_NODE_M = 0.010  # so near, in plan, an arm's tool is over a node
MOST_NAMED = 3  # pairs of targets in one sentence
BASE = f"base: {flow({'origin_m': ['x', 'y']})}"


@dataclass(frozen=True, kw_only=True)
class ToolPoint:
    """Position of an arm's tool at a target, m; for a mobile robot, of the node, at height 0."""

    pose: Pose
    at: Point


@dataclass(frozen=True, kw_only=True)
class Placed:
    """Robot of a cell with its points; `drives`: the robot is on a grid.

    `foot_m` is the radius of an arm's foot. `is_declared`: the plant file says where the robot stands, and
    does not leave it at the origin.
    """

    cell: Cell
    space: Workspace
    origin: Placement
    points: list[ToolPoint]
    drives: bool
    foot_m: float = 0.0

    @property
    def name(self) -> str:
        return self.space.robot.name

    def is_compared(self, other: Placed) -> bool:
        """True if the file says where one of the two stands; `grid_check` compares two grids."""
        declared = self.origin.is_declared or other.origin.is_declared
        return declared and self.name != other.name and not (self.drives and other.drives)

    def meets_on_purpose(self, other: Placed) -> bool:
        """True for an arm and a mobile robot of one cell: they hand over parts where there is no zone."""
        return self.cell is other.cell and self.drives != other.drives

    def apart_m(self, other: Placed) -> float:
        return math.dist((self.origin.x, self.origin.y), (other.origin.x, other.origin.y))

    def stands_in(self, other: Placed) -> bool:
        """True if the feet of two arms overlap; a rail, which is wide, counts as wide as the other foot."""
        return self.apart_m(other) < 2 * min(self.foot_m, other.foot_m)


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
            alike = f"{cell.name}: {one} and {other} of {space.robot.name} are one place"
            yield alike + "; move one of them, or delete it"


def _meetings(plant: PlantModel) -> Iterator[str]:
    """Arms that stand in each other, and meetings of other arms with each other and with mobile robots."""
    spaces = [(cell, space) for cell in plant.cells for space in cell.spaces]
    if not any(_origin(space.robot).is_declared for _, space in spaces if _is_placed(space.robot)):
        return
    placed = [_placed(plant, cell, space) for cell, space in spaces if _is_placed(space.robot)]
    for one, other in combinations(placed, 2):
        if one.is_compared(other) and one.stands_in(other):
            yield _in_each_other(one, other)
        elif one.is_compared(other) and (near := list(_near(one, other))):
            yield _sentence(one, other, near)


def _is_placed(robot: Robot) -> bool:
    return drawn_arm(robot) is not None or robot.floor_grid is not None


def _origin(robot: Robot) -> Placement:
    """The place of an arm's base, or of a grid."""
    arm = drawn_arm(robot)
    return robot.floor_grid.origin if arm is None else arm.base


def _placed(plant: PlantModel, cell: Cell, space: Workspace) -> Placed:
    arm, grid, origin = drawn_arm(space.robot), space.robot.floor_grid, _origin(space.robot)
    if arm is None:
        nodes = [ToolPoint(pose=pose, at=(*on_floor(grid, pose), 0.0)) for pose in space.poses]
        return Placed(cell=cell, space=space, origin=origin, points=nodes, drives=True)
    body = bodies.read(robot_urdf(plant, arm.name))
    frame = kinematics.floor((origin.x, origin.y, origin.yaw))
    points = [
        ToolPoint(pose=pose, at=kinematics.at(kinematics.tool(body, pose.joints, frame)))
        for pose in space.poses
    ]
    return Placed(cell=cell, space=space, origin=origin, points=points, drives=False, foot_m=foot_m(body))


def _near(one: Placed, other: Placed) -> Iterator[tuple[Pose, Pose, float]]:
    """The pairs of poses at which two robots would be near each other without a common zone, and how near."""
    axes, least = (2, OVER_NODE_M) if one.drives or other.drives else (3, MEETING_M)
    for its in one.points:
        for others in other.points:
            apart = math.dist(its.at[:axes], others.at[:axes])
            zones = (its.pose.zones, others.pose.zones)
            is_wanted = one.meets_on_purpose(other) and not any(zones)
            if apart <= least and not zones[0] & zones[1] and not is_wanted:
                yield its.pose, others.pose, apart


def _in_each_other(one: Placed, other: Placed) -> str:
    absent = [each.name for each in (one, other) if not each.origin.is_declared]
    why = f"{absent[0]} has no base and is at the origin" if absent else "give each its own place"
    stand = f"{one.name} and {other.name} stand in each other, {one.apart_m(other) * 1000:.0f} mm apart"
    return f"{one.cell.name}: {stand}; {why}; write {BASE}"


def _sentence(one: Placed, other: Placed, near: Sequence[tuple[Pose, Pose, float]]) -> str:
    pairs = [f"{a.name} and {b.name} ({apart * 1000:.0f} mm apart)" for a, b, apart in near[:MOST_NAMED]]
    more = "" if len(near) <= MOST_NAMED else f" and {len(near) - MOST_NAMED} more"
    robots = f"{one.name} and {other.name}"
    meet = f"{robots} can meet at {', '.join(pairs)}{more}, which no zone has in common"
    return f"{one.cell.name}: {meet}; put them into one zone, {_zone(one, other, near)}"


def _zone(one: Placed, other: Placed, near: Sequence[tuple[Pose, Pose, float]]) -> str:
    """The text of a zone with all these poses; one of them may be in a zone already."""
    both = [(one.cell, a) for a, _, _ in near] + [(other.cell, b) for _, b, _ in near]
    name = next((zone for _, pose in both for zone in sorted(pose.zones)), "NAME")
    poses = list(dict.fromkeys(f"{cell.name} {pose.name}" for cell, pose in both))
    return f"zones: {flow({name: {'poses': poses}})}"
