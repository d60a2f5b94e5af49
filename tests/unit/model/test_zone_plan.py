"""Which zones each leg of a way takes: those of its poses, its moves and a recovery from any of them."""

from __future__ import annotations

from dataclasses import replace
from itertools import permutations
from typing import Any

import pytest
from tests.cells import with_poses

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import Crossing, Pose, Workspace
from arboleda.model.zone_plan import Leg, entered, passed, plan, recovery_zones
from arboleda.plant_file.storage_form import plan_problems
from arboleda.testing import shipped
from arboleda.testing.storage_layout import StorageLayout

NONE = frozenset[str]()
STATION, OTHER, PLACE = 7, 4, 8  # PLACE is where the shipped cell palletizes to


def cell(*crossings: tuple[str, str, str], **zones: str) -> StorageLayout:
    """The shipped cell with poses in zones (`pickup="x y"`) and moves through one (from, to, zone)."""
    plain = shipped("sis_a").cells[0]

    def placed(pose: Pose) -> Pose:
        names = zones.get(pose.name.replace("-", "").replace(" ", ""), "")
        return replace(pose, zones=frozenset(names.split()))

    poses = {target: placed(pose) for target, pose in plain.reach["ra1"].targets.items()}
    ways = [Crossing(a=a, b=b, zones=frozenset({zone})) for a, b, zone in crossings]
    return StorageLayout(with_poses(plain, *ways, **poses))


def storage(made: StorageLayout) -> list[Any]:
    way = (made.home, made.pickup, made.stations[STATION], made.home)
    return [(leg.start, leg.end, leg.zones) for leg in plan(made.space, way, made.pickup)]


LEGS = {  # poses of the way: home 0, pick-up 1, station 7 2, home 3
    "no zones": (cell(), [(0, 1, NONE), (1, 2, NONE), (2, 3, NONE)]),
    "pick-up": (cell(pickup="x"), [(0, 2, {"x"}), (2, 3, NONE)]),
    "station": (cell(station7="x"), [(0, 1, NONE), (1, 3, {"x"})]),
    "both": (cell(pickup="x", station7="y z"), [(0, 3, {"x", "y", "z"})]),
    "another station": (cell(station4="x"), [(0, 1, NONE), (1, 2, NONE), (2, 3, NONE)]),
    "move": (cell(("pick-up", "station 7", "x")), [(0, 1, NONE), (1, 2, {"x"}), (2, 3, NONE)]),
    "move the other way round": (
        cell(("station 7", "pick-up", "x")),
        [(0, 1, NONE), (1, 2, {"x"}), (2, 3, NONE)],
    ),
    "move home, also after a failure": (
        cell(("home", "station 7", "x")),
        [(0, 1, NONE), (1, 2, {"x"}), (2, 3, {"x"})],
    ),
    "move of a recovery from the pick-up": (
        cell(("home", "pick-up", "x")),
        [(0, 1, {"x"}), (1, 2, {"x"}), (2, 3, NONE)],
    ),
    "two zones crossed by one move": (
        cell(("pick-up", "station 7", "x"), ("pick-up", "station 7", "y")),
        [(0, 1, NONE), (1, 2, {"x", "y"}), (2, 3, NONE)],
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", LEGS.values(), ids=LEGS)
def test_a_storage_way_has_these_legs(case: tuple[StorageLayout, list[Any]]) -> None:
    made, legs = case
    assert storage(made) == legs


def test_a_part_that_may_have_to_go_back_needs_the_zone_of_the_pick_up() -> None:
    made = cell(pickup="x", station4="y")
    pick, place = made.stations[OTHER], made.stations[PLACE]
    assert plan(made.space, (made.home, pick, place), made.pickup) == [
        Leg(start=0, end=2, zones=frozenset({"x", "y"}))
    ]


def test_an_arm_that_stands_at_a_station_starts_there() -> None:
    made = cell(("station 8", "pick-up", "x"), ("home", "station 8", "y"))
    start = made.palletizing.place
    legs = plan(made.space, (start, made.pickup, made.stations[STATION], made.home), made.pickup)
    assert legs[0] == Leg(start=0, end=1, zones=frozenset({"x", "y"}))
    legs = plan(made.space, (start, made.home, made.palletizing.pick, made.palletizing.place), made.pickup)
    assert [(leg.start, leg.end) for leg in legs] == [(0, 1), (1, 2), (2, 3)]
    assert "y" in legs[0].zones


@pytest.mark.parametrize("name", ["home", "station 8"])
def test_a_way_starts_and_ends_outside(name: str) -> None:
    made = cell(**{name.replace(" ", ""): "x"})
    with pytest.raises(ConfigError, match=f"{name} lies in zone x, so no way may start or end there"):
        plan(made.space, (made.home, made.home, made.palletizing.pick, made.palletizing.place), made.pickup)


def test_no_problem_with_poses_outside_or_passed_through() -> None:
    assert plan_problems(cell().cell) == plan_problems(cell(pickup="x", station7="x y").cell) == {}


def test_a_place_in_a_zone_is_a_problem_with_its_pose() -> None:
    assert plan_problems(cell(station8="y").cell) == {
        "station 8": "in cell sis_a: station 8 lies in zone y; "
        "palletizing ends and waits there, so it must be outside all zones"
    }


MOBILE = StorageLayout(shipped("sis_a").cells[0]).mobile


def on_grid(home: int, goal: int, zoned: int) -> Workspace:
    """A mobile robot with two nodes where it goes, and one in a zone where it has nothing to do."""
    poses = [Pose(name=name, q=node) for name, node in (("home", home), ("goal", goal))]
    gate = Pose(name="gate", q=zoned, zones=frozenset({"x"}))
    return Workspace(robot=MOBILE, home=poses[0], poses=(*poses, gate))


@pytest.mark.parametrize("zoned", range(MOBILE.grid.size))
def test_a_leg_on_a_grid_holds_what_lies_on_its_way_and_on_the_way_home_from_wherever_it_halts(
    zoned: int,
) -> None:
    """All ways of a grid of nine nodes."""
    route = MOBILE.grid.route
    others = (node for node in range(MOBILE.grid.size) if node != zoned)
    for home, goal in permutations(others, 2):
        space = on_grid(home, goal, zoned)
        (leg,) = plan(space, space.poses[:2], None)
        halted = route(home, goal)
        ways = {node for spot in halted for node in (*route(spot, home), *route(home, spot))}
        assert (leg.zones == {"x"}) is (zoned in ways | {*halted} | {*route(goal, home)}), (home, goal)


def test_a_motion_on_a_grid_enters_all_that_its_nodes_lie_in_but_where_it_begins() -> None:
    space = on_grid(6, 0, 3)
    assert entered(space, space.home, (6, 3, 0)) == {"x"}
    assert entered(space, None, (4, 3, 0)) == {"x"}
    assert entered(space, None, (3, 0)) == NONE
    assert entered(space, None, (3,)) == {"x"}
    assert entered(space, None, (6, 7, 4, 1, 0)) == NONE


def test_a_recovery_on_a_grid_needs_what_lies_between_a_pose_and_home() -> None:
    space = on_grid(6, 0, 3)
    assert recovery_zones(space, space.poses[1], None) == {"x"}
    assert recovery_zones(space, space.home, None) == NONE


def test_what_lies_between_two_nodes_is_that_of_the_ways_there_and_back_without_their_ends() -> None:
    space = on_grid(6, 0, 3)
    assert (passed(space, 6, 0), passed(space, 3, 0), passed(space, None, 0)) == ({"x"}, NONE, NONE)


def test_nothing_lies_between_two_poses_of_an_arm_but_what_is_named() -> None:
    made = cell(("home", "pick-up", "x"))
    space = made.space
    assert passed(space, made.home.q, made.pickup.q) == NONE
