"""Every task of the shipped plant takes its part from where the mobile stands, to where it can stay."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from itertools import combinations, permutations, product

import pytest
from tests.lengths import sample

from arboleda.geometry import bodies, kinematics
from arboleda.geometry.kinematics import deck
from arboleda.geometry.part_size import PART_HEIGHT_M, PART_RADIUS_M
from arboleda.kinds.arm import Arm
from arboleda.kinds.joints import Joint
from arboleda.kinds.mobile import Mobile
from arboleda.model import text
from arboleda.model.plant_model import Cell, Pose
from arboleda.plant_file.urdf import robot_urdf
from arboleda.testing import shipped
from arboleda.testing.storage_layout import StorageLayout

CELLS = {cell.name: cell for cell in shipped().cells}
TASKS = [
    f"{cell.name} {path} {station.name.removeprefix('station ')}"
    for cell in CELLS.values()
    for path in cell.paths
    for station in cell.stations
]
FEW_MM = 0.003
STEP_S = 0.02
BASE_M = 0.15  # the largest foot of an arm
REACH_M = {"scara": 0.65 + 0.52, "cr10a": 0.607 + 0.568 + 0.125 + 0.1084}
Q = tuple[float, ...]


@cache
def drawn(name: str) -> bodies.Body:
    return bodies.read(robot_urdf(shipped(), name))


def frames(arm: Arm, q: Q) -> dict[str, kinematics.Matrix]:
    return kinematics.place(drawn(arm.name), q, kinematics.floor((arm.base.x, arm.base.y, arm.base.yaw)))


@cache
def part_at(arm: Arm, q: Q) -> tuple[kinematics.Point, kinematics.Point, kinematics.Point]:
    """The tool's point, the middle and the far end of the part in it, at joints as the motors hold them."""
    tool = frames(arm, q)[bodies.tip(drawn(arm.name))]
    return (
        kinematics.at(tool),
        kinematics.at(tool, (0, 0, PART_HEIGHT_M / 2)),
        kinematics.at(tool, (0, 0, PART_HEIGHT_M)),
    )


def held(arm: Arm, pose: Pose) -> tuple[kinematics.Point, kinematics.Point, kinematics.Point]:
    return part_at(arm, arm.motion.quantised(pose.q))


def carried(mobile: Mobile, node: int) -> kinematics.Point:
    """The middle of the upper face of the part that a mobile on this node carries."""
    origin = mobile.grid.origin
    floor = kinematics.floor((origin.x, origin.y, origin.yaw))
    x, y = mobile.grid.position(node)
    return kinematics.at(floor, (x, y, deck(drawn(mobile.name)) + PART_HEIGHT_M))


def stored(cell: Cell) -> dict[str, kinematics.Point]:
    """The middle of the part in each station."""
    return {station.name: held(StorageLayout(cell).arm, station)[1] for station in cell.stations}


def on_the_way(arm: Arm, start: Pose, goal: Pose) -> Iterator[Q]:
    """Where the joints are on a move, each on its own ramp."""
    rows = list(zip(arm.joints, start.q, goal.q, strict=True))
    end_s = max(joint.travel_s(there - here) for joint, here, there in rows)
    for step in range(int(end_s / STEP_S)):
        yield tuple(here + driven(joint, there - here, step * STEP_S) for joint, here, there in rows)


def driven(joint: Joint, distance: float, seconds: float) -> float:
    """How far a joint is after so long, from rest to rest."""
    whole, end_s = abs(distance), joint.travel_s(distance)
    ramp_s = min(joint.speed / joint.acceleration, end_s / 2)
    top = joint.acceleration * ramp_s
    if seconds >= end_s:
        return distance
    if seconds < ramp_s:
        gone = joint.acceleration * seconds**2 / 2
    elif seconds > end_s - ramp_s:
        gone = whole - joint.acceleration * (end_s - seconds) ** 2 / 2
    else:
        gone = top * ramp_s / 2 + top * (seconds - ramp_s)
    return math.copysign(gone, distance)


def strikes(a: kinematics.Point, b: kinematics.Point) -> bool:
    """Whether two parts, each given by its middle, are in each other."""
    return math.dist(a[:2], b[:2]) < 2 * PART_RADIUS_M and abs(a[2] - b[2]) < PART_HEIGHT_M


@pytest.mark.sampled(5)
@pytest.mark.parametrize("task", sample(TASKS, every=13))
def test_a_task_takes_the_part_from_the_mobile_and_puts_it_into_its_station(task: str) -> None:
    order = text.parse(task, shipped())
    cell = CELLS[order.cell]
    layout = StorageLayout(cell)
    path, place = layout.path(order.values["path"]), layout.space.targets[order.values["station"]]
    pickup = layout.pickup_of(path)
    tool, top = held(layout.arm, pickup), carried(layout.mobile, path.nodes[-1])
    assert math.dist(tool[0], top) < FEW_MM
    assert tool[1][2] < tool[0][2], "the part hangs below the tool"
    station = held(layout.arm, place)
    assert station[0][2] - station[2][2] == pytest.approx(PART_HEIGHT_M, abs=1e-4), "it stands upright"
    assert station[2][2] > 0
    others = [middle for name, middle in stored(cell).items() if name != place.name]
    for q in on_the_way(layout.arm, pickup, place):
        _, middle, low = part_at(layout.arm, q)
        assert low[2] > 0
        assert not any(strikes(middle, other) for other in others)
    for q in on_the_way(layout.arm, place, layout.home):
        tip, _, _ = part_at(layout.arm, q)
        assert all(tip[2] > z + PART_HEIGHT_M / 2 - FEW_MM or away(tip, (x, y)) for x, y, z in others)


def away(tip: kinematics.Point, spot: tuple[float, float]) -> bool:
    return math.dist(tip[:2], spot) > 2 * PART_RADIUS_M


@pytest.mark.parametrize("name", CELLS)
def test_stations_are_at_least_a_part_apart(name: str) -> None:
    for a, b in combinations(stored(CELLS[name]).values(), 2):
        assert math.dist(a[:2], b[:2]) > 2 * PART_RADIUS_M + FEW_MM


@pytest.mark.parametrize("name", CELLS)
def test_nothing_of_an_arm_is_below_the_floor_at_a_pose(name: str) -> None:
    cell = CELLS[name]
    layout = StorageLayout(cell)
    for pose in layout.space.poses:
        assert all(
            frame[2][3] >= 0 for frame in frames(layout.arm, layout.arm.motion.quantised(pose.q)).values()
        )


@pytest.mark.sampled(5)
@pytest.mark.parametrize(("one", "other"), list(permutations(CELLS, 2)), ids=str)
def test_no_arm_reaches_through_the_base_of_another(one: str, other: str) -> None:
    layout = StorageLayout(CELLS[one])
    arm = layout.arm
    foot = StorageLayout(CELLS[other]).arm.base
    spot = (foot.x, foot.y)
    if math.dist((arm.base.x, arm.base.y), spot) > REACH_M[arm.model] + BASE_M:
        return
    goals = [layout.home, *layout.pickups, *layout.stations]
    for start, goal in product(goals, repeat=2):
        for q in list(on_the_way(arm, start, goal))[::10]:
            assert all(math.dist((f[0][3], f[1][3]), spot) > 2 * BASE_M for f in frames(arm, q).values())


def test_no_pose_of_an_arm_is_over_the_grid_or_the_rack_of_another() -> None:
    for cell in CELLS.values():
        layout = StorageLayout(cell)
        for other in CELLS.values():
            if other is cell:
                continue
            spots = [carried(StorageLayout(other).mobile, node) for node in range(9)] + list(
                stored(other).values()
            )
            for pose in layout.space.poses:
                middle = held(layout.arm, pose)[1]
                assert all(math.dist(middle[:2], spot[:2]) > 0.2 for spot in spots), (cell.name, pose.name)
