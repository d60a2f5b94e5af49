"""Check of a plant file's layout: whether each robot and each part can be where the file says."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import cast

from arboleda.geometry import bodies, kinematics
from arboleda.geometry.bodies import Body
from arboleda.geometry.hull import hull
from arboleda.geometry.kinematics import Matrix, Point, deck
from arboleda.geometry.part_size import PART_HEIGHT_M, PART_RADIUS_M
from arboleda.kinds.arm import Arm
from arboleda.kinds.floor import Placement
from arboleda.kinds.joints import Joint
from arboleda.kinds.mobile import Mobile
from arboleda.model.errors import ArboledaError
from arboleda.model.plant_model import Cell, PlantModel, Pose
from arboleda.plant_file.arrays import Array
from arboleda.plant_file.urdf import drawn_arm, robot_urdf

from . import layout_mends
from .layout_mends import Outline, edges

BESIDE_M = 0.010  # a pick-up may be so far beside the part that it takes
ABOVE_M = 0.010  # and so far above it, which a suction cup bridges
ROUNDING_M = 0.001
EVEN_M = 0.001  # a target of an array may be so far beside an even grid


def warnings(plant: PlantModel) -> tuple[str, ...]:
    """A sentence for each place that cannot be as the file says, or the reason why nothing was checked."""
    try:
        cells = [Stand.of(plant, cell) for cell in plant.cells if _hands_over(cell)]
        uneven = [*_uneven(plant)]
    except ArboledaError as error:
        return (f"nobody has looked where things stand: {error}",)
    misplaced = [each for cell in cells for each in (*_pickups(cell), *_stations(cell), *_below(cell))]
    return (*misplaced, *_crowded(cells), *uneven)


def _hands_over(cell: Cell) -> bool:
    """True if an arm of the cell takes parts from a mobile robot."""
    return cell.handover is not None and bool(cell.taker.robot.joints and cell.giver.robot.floor_grid)


def _uneven(plant: PlantModel) -> Iterator[str]:
    """The arrays of targets at which the tool of an arm is not on an even grid between the corners."""
    for cell in plant.cells:
        for group, rows, columns in cell.grids:
            array = Array(group=group, rows=rows, columns=columns)
            for space in cell.spaces:
                poses = {pose.name: pose for pose in space.poses}
                arm = drawn_arm(space.robot)
                if arm is not None and array.names[0] in poses:
                    yield from _uneven_of(plant, arm, array, [poses[name] for name in array.names])


def _uneven_of(plant: PlantModel, arm: Arm, array: Array, poses: Sequence[Pose]) -> Iterator[str]:
    body, base = _body(plant, arm.name), _frame(arm.base)
    points = [kinematics.at(kinematics.tool(body, pose.joints, base)) for pose in poses]
    corners = [points[index] for index in array.corners]
    off = [math.dist(point, array.even(index, corners)) for index, point in enumerate(points)]
    worst = max(range(len(off)), key=off.__getitem__)
    if off[worst] > EVEN_M:
        where = f"{array.names[worst]}, {_mm(off[worst])} beside an even grid"
        why = f"the joints of {arm.name} are interpolated between the corners of {array.group}"
        yield f"{where}: {why}; where that matters, name these targets one by one"


@dataclass(frozen=True, kw_only=True)
class Stand:
    """One cell in the world, in m: the body of its arm, and the outlines of arm and grid on the floor.

    The arm takes the parts that the mobile robot brings.
    """

    cell: Cell
    arm: Arm
    mobile: Mobile
    body: Body
    deck_m: float
    base: Outline
    grid: Outline

    @classmethod
    def of(cls, plant: PlantModel, cell: Cell) -> Stand:
        arm, mobile = cast(Arm, cell.taker.robot), cast(Mobile, cell.giver.robot)
        taker, giver = (_body(plant, robot.name) for robot in (arm, mobile))
        return cls(
            cell=cell,
            arm=arm,
            mobile=mobile,
            body=taker,
            deck_m=deck(giver),
            base=hull([(arm.base.x, arm.base.y)], foot_m(taker)),
            grid=_grid(mobile, _wide(bodies.links(giver))),
        )

    def tool(self, pose: Pose) -> Matrix:
        """The tool's frame at a pose."""
        return kinematics.tool(self.body, pose.joints, _frame(self.arm.base))

    def node(self, node: int) -> Point:
        """The upper end of a part that a mobile carries on this node."""
        x, y = self.mobile.grid.position(node)
        frame = _frame(self.mobile.grid.origin)
        return kinematics.at(frame, (x, y, self.deck_m + PART_HEIGHT_M))

    def part(self, pose: Pose) -> Point:
        """The middle of a part that the tool holds at a pose."""
        return kinematics.at(self.tool(pose), (0, 0, PART_HEIGHT_M / 2))

    @property
    def pickups(self) -> dict[str, Pose]:
        """By the code of a path, the pose at which the arm takes a part that came on that path."""
        handover, paths = self.cell.handover, self.cell.giver.paths
        assert handover is not None
        return {path.code: self.cell.taker.targets[handover.after(path.code)] for path in paths}

    @property
    def reach_m(self) -> float:
        """The farthest that the tool of the arm can be from the arm's foot, in plan, m."""
        frames = kinematics.place(self.body, self.arm.reference)
        links = bodies.tool_chain(self.body)
        moving = [link for link in links if link["moves"]]
        turning = [link for link in moving if link["moves"]["type"] == "turn"]
        upright = all(_is_upright(frames, link) for link in turning)
        points = [kinematics.at(frames[link["link"]]) for link in links[links.index(moving[0]) :]]
        if upright:
            points = [(x, y, 0.0) for x, y, _ in points]
        slides = sum(_slide_m(self.arm, frames, link, upright) for link in moving)
        first = math.hypot(*points[0][:2])
        return first + sum(math.dist(a, b) for a, b in pairwise(points)) + slides


def _pickups(stand: Stand) -> Iterator[str]:
    """The pick-ups that are not where the mobile robot brings the part."""
    cell, pickups = stand.cell, stand.pickups
    ends = {(path.nodes[-1], pickups[path.code].name): path for path in reversed(cell.giver.paths)}
    off = [_between(stand.node(node), stand.tool(pickups[path.code])) for (node, _), path in ends.items()]
    moved = layout_mends.moved_grid(stand.mobile, off, BESIDE_M) if off else ""
    for (node, _), path in ends.items():
        pickup, (x, y, top) = pickups[path.code], stand.node(node)
        tool = kinematics.at(stand.tool(pickup))
        beside, over = math.dist(tool[:2], (x, y)), tool[2] - top
        part = f"a part on {stand.mobile.name} at node {node}, where path {path.code} ends"
        away = math.dist((x, y), (stand.arm.base.x, stand.arm.base.y))
        if away > stand.reach_m + BESIDE_M:
            reach = f"{stand.arm.name} reaches {stand.reach_m:.2f} m"
            sentence = (
                f"{cell.name}: node {node} is out of reach, {away:.2f} m away; {reach} (path {path.code})"
            )
            yield sentence + moved
        elif beside > BESIDE_M:
            yield f"{cell.name}: {pickup.name} is {_mm(beside)} beside {part}{moved}"
        elif not -ROUNDING_M <= over <= ABOVE_M:
            side = "above" if over > 0 else "below"
            mend = layout_mends.raised(stand.arm, stand.body, pickup, -over)
            yield f"{cell.name}: {pickup.name} is {_mm(abs(over))} {side} the top of {part}{mend}"


def _stations(stand: Stand) -> Iterator[str]:
    """The stations whose parts would be in each other."""
    size = f"a part is {_mm(2 * PART_RADIUS_M)} wide and {_mm(PART_HEIGHT_M)} high"
    places = [(pose.name, stand.part(pose)) for pose in stand.cell.stations]
    for (one, a), (other, b) in combinations(places, 2):
        apart, over = math.dist(a[:2], b[:2]), abs(a[2] - b[2])
        if apart < 2 * PART_RADIUS_M and over < PART_HEIGHT_M - ROUNDING_M:
            number = other.removeprefix("station ")
            mend = f"; put them {_mm(2 * PART_RADIUS_M)} apart"
            yield f"{stand.cell.name}: {one} and {number} are {_mm(math.dist(a, b))} apart; {size}{mend}"


def _below(stand: Stand) -> Iterator[str]:
    """The poses at which a part, or at home the tool, would be below the floor."""
    for pose in stand.cell.taker.poses:
        tool = stand.tool(pose)
        points = [kinematics.at(tool)]
        if pose.name != stand.cell.taker.home.name:
            points.append(kinematics.at(tool, (0, 0, PART_HEIGHT_M)))
        low = min(z for _, _, z in points)
        if low < -ROUNDING_M:
            what = "the tool" if low == points[0][2] else "the part in the tool"
            mend = layout_mends.raised(stand.arm, stand.body, pose, -low)
            yield f"{stand.cell.name}: at {pose.name}, {what} is {_mm(-low)} below the floor{mend}"


def _crowded(stands: Sequence[Stand]) -> Iterator[str]:
    """The bases, grids and stations that take the same piece of floor."""
    floor = [(f"the base of {stand.arm.name}", stand.base) for stand in stands]
    floor += [(f"the grid of {stand.mobile.name}", stand.grid) for stand in stands]
    for (one, a), (other, b) in combinations(floor, 2):
        if _overlap(a, b):
            yield f"{one} and {other} overlap{layout_mends.apart(a, b)}"
    for stand in stands:
        for pose in stand.cell.stations:
            x, y, _ = stand.part(pose)
            spot = hull([(x, y)], PART_RADIUS_M)
            for what, outline in floor:
                if _overlap(spot, outline):
                    mend = layout_mends.apart(spot, outline)
                    yield f"{stand.cell.name}: {pose.name} stands on {what}{mend}"


def _between(node: Point, tool: Matrix) -> tuple[float, float]:
    """The distance of a tool from a node along each axis of the plan, m."""
    x, y, _ = kinematics.at(tool)
    return x - node[0], y - node[1]


def _body(plant: PlantModel, name: str) -> Body:
    return bodies.read(robot_urdf(plant, name))


def _frame(placement: Placement) -> Matrix:
    return kinematics.floor((placement.x, placement.y, placement.yaw))


def _grid(mobile: Mobile, margin: float) -> Outline:
    """The outline of all nodes, with the reach of the mobile robot beyond its node."""
    frame = _frame(mobile.grid.origin)
    far_x, far_y = mobile.grid.position(mobile.grid.size - 1)
    corners = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    ends = [((x > 0) * far_x + x * margin, (y > 0) * far_y + y * margin, 0.0) for x, y in corners]
    return [kinematics.at(frame, end)[:2] for end in ends]


def foot_m(body: Body) -> float:
    """The radius of an arm's foot: of all that no joint moves, in plan, m."""
    return _wide(_fixed(body))


def _fixed(body: Body) -> Iterator[Body]:
    """The links that no joint moves."""
    if body["moves"] is None:
        yield body
        for child in body["children"]:
            yield from _fixed(child)


def _wide(links: Iterable[Body]) -> float:
    """The farthest that a box or an upright cylinder of these links extends from its middle, in plan, m."""
    shapes = [shape for link in links for shape in link["shapes"] if not any(shape["rpy"])]
    return max((_half(shape) for shape in shapes), default=0.0)


def _half(shape: Body) -> float:
    return max(shape["size"][:2]) / 2 if shape["kind"] == "box" else float(shape["size"][0])


def _is_upright(frames: Mapping[str, Matrix], link: Body) -> bool:
    return abs(kinematics.upright(frames[link["link"]], link["moves"]["axis"])) > 1 - 1e-6


def _slide_m(arm: Arm, frames: Mapping[str, Matrix], link: Body, upright: bool) -> float:
    """The length in plan that a sliding joint may add, m; 0 where it slides upright, as all turning axes."""
    if link["moves"]["type"] == "turn" or (upright and _is_upright(frames, link)):
        return 0.0
    joint: Joint = arm.joints[link["moves"]["index"]]
    return max(abs(joint.lower), abs(joint.upper))


def _overlap(a: Outline, b: Outline) -> bool:
    """True if two convex outlines share a piece of floor: no edge of either separates them.

    A shape that is too thin for an outline takes no floor.
    """
    return bool(a and b) and not any(_parts(edge, a, b) for outline in (a, b) for edge in edges(outline))


def _parts(edge: tuple[Sequence[float], Sequence[float]], a: Outline, b: Outline) -> bool:
    (x0, y0), (x1, y1) = edge
    across = (y1 - y0, x0 - x1)
    of_a, of_b = ([x * across[0] + y * across[1] for x, y in outline] for outline in (a, b))
    return max(of_a) <= min(of_b) or max(of_b) <= min(of_a)


def _mm(metres: float) -> str:
    return f"{metres * 1000:.0f} mm"
