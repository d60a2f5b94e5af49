"""What stands in a plant, where the plant file and the robots' drawings put it."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import pytest
from tests.cells import with_poses

from arboleda.dashboard.twin.scene import MARGIN, scene
from arboleda.geometry import kinematics
from arboleda.geometry.bodies import Body
from arboleda.geometry.hull import hull
from arboleda.model.plant_model import Cell, Crossing, PlantModel, Pose, Workspace
from arboleda.testing import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda.views.geometry import places


def zoned() -> PlantModel:
    """`sis_a` with a zone around its pick-up and one on its way from home to station 2."""
    plant = shipped("sis_a")
    cell = plant.cells[0]
    ways = (Crossing(a="home", b="station 2", zones=frozenset({"way"})),)
    pickup = replace(StorageLayout(cell).pickup, zones=frozenset({"spot"}))
    return replace(plant, cells=(with_poses(cell, *ways, pickup=pickup),), zones=("spot", "way"))


def at(frame: list[float]) -> list[float]:
    return [frame[3], frame[7], frame[11]]


def test_a_scene_is_plain_json(drawings: dict[str, Body]) -> None:
    made = scene(places(shipped()), drawings)
    assert json.loads(json.dumps(made)) == made


def test_robots_stand_where_the_plant_file_puts_them(drawings: dict[str, Body]) -> None:
    robots = {robot["name"]: robot for robot in scene(places(shipped()), drawings)["robots"]}
    assert robots["ra2"]["at"] == pytest.approx([1.5, 0.0, math.radians(230.61)])
    assert robots["rm_sis_a"]["at"] == pytest.approx([-0.1, -1.366, 0])


def test_a_station_is_at_the_tool_of_its_pose(drawings: dict[str, Body]) -> None:
    cell = scene(places(shipped()), drawings)["cells"][0]
    q1, q2 = math.radians(220.6 + 10), math.radians(20)  # station 7: column 1, row 2
    x, y = (0.65 * f(q1) + 0.52 * f(q1 + q2) for f in (math.cos, math.sin))
    assert at(cell["stations"][7]) == pytest.approx([x, y, 0.05])
    assert len(cell["stations"]) == 9


def test_a_part_on_a_mobile_stands_on_its_deck(drawings: dict[str, Body]) -> None:
    decks = {robot["name"]: robot["deck"] for robot in scene(places(shipped()), drawings)["robots"]}
    assert (decks["rm_sis_a"], decks["ra1"]) == (pytest.approx(0.108), 0.0)


def test_a_rack_is_a_board_under_each_height_at_which_parts_stand(drawings: dict[str, Body]) -> None:
    a, _, c = scene(places(shipped()), drawings)["cells"]
    assert [shelf["top"] for shelf in a["shelves"]] == pytest.approx([0.01])
    assert [shelf["top"] for shelf in c["shelves"]] == pytest.approx([0.25])
    for cell in (a, c):
        for frame in cell["stations"]:
            assert inside((frame[3], frame[7]), cell["shelves"][0]["outline"])


def test_a_zone_is_around_the_tool_at_its_poses(drawings: dict[str, Body]) -> None:
    made = scene(places(zoned()), drawings)
    spot = made["zones"][0]
    x, y, z = at(made["cells"][0]["pickups"][0])
    assert all(math.dist((x, y), corner) == pytest.approx(MARGIN, abs=1e-6) for corner in spot["outline"])
    assert (spot["low"], spot["high"]) == pytest.approx((z - MARGIN, z + MARGIN))


def test_a_zone_of_a_mobile_robot_is_around_its_node(drawings: dict[str, Body]) -> None:
    plant = zoned()
    (cell,) = plant.cells
    layout = StorageLayout(cell)
    pose = Pose(name="dock", q=5, zones=frozenset({"dock"}))
    space = Workspace(robot=layout.mobile, home=Pose(name="home", q=0), poses=(pose,))
    driven = Cell(name="drive", queue_limit=1, members=(("mobile", layout.mobile),), spaces=(space,))
    made = scene(places(replace(plant, cells=(driven,), zones=("dock", "lid"))), drawings)
    (zone,) = made["zones"]  # what no robot that is drawn gets into has no place
    grid = layout.mobile.grid
    turn = (math.cos(grid.origin.yaw), math.sin(grid.origin.yaw))
    x, y = grid.position(5)
    point = (grid.origin.x + x * turn[0] - y * turn[1], grid.origin.y + x * turn[1] + y * turn[0])
    assert zone["zone"] == "dock" and inside(point, zone["outline"])


def test_a_zone_of_a_move_covers_the_way_between_its_ends(drawings: dict[str, Body]) -> None:
    plant = zoned()
    way = scene(places(plant), drawings)["zones"][1]
    cell = plant.cells[0]
    layout = StorageLayout(cell)
    middle = [a / 2 + b / 2 for a, b in zip(layout.home.q, cell.stations[2].q, strict=True)]
    base = kinematics.floor((layout.arm.base.x, layout.arm.base.y, layout.arm.base.yaw))
    for q in (layout.home.q, middle, cell.stations[2].q):
        x, y, _ = kinematics.at(kinematics.tool(drawings["ra1"], q, base))
        assert inside((x, y), way["outline"])


def test_everything_lies_within_the_bounds(drawings: dict[str, Body]) -> None:
    made = scene(places(shipped()), drawings)
    low, high = made["bounds"]
    for cell in made["cells"]:
        for frame in cell["stations"]:
            assert all(a < value < b for a, value, b in zip(low, at(frame), high, strict=True))


def test_an_outline_goes_around_its_points_counterclockwise() -> None:
    outline = hull([(0, 0), (1, 0), (0.5, 0.2)], 0.1)
    assert inside((0.5, 0.1), outline) and not inside((0.5, -0.2), outline)
    assert hull([], 0.1) == []


def inside(point: tuple[float, float], outline: list[list[float]]) -> bool:
    (x, y), pairs = point, zip(outline, [*outline[1:], outline[0]], strict=True)
    return all((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) > 0 for a, b in pairs)
