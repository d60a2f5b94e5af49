"""Which zones each leg of a way takes: those of its poses, its moves and a recovery from any of them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import Crossing, Pose
from arboleda.recipes.storage import palletizing_way, plan_problems, storage_way
from arboleda.recipes.storage_cell import Palletizing, StorageCell
from arboleda.testing import shipped
from arboleda.trees.zone_plan import Leg, plan

NONE = frozenset[str]()
STATION, OTHER, PLACE = 7, 4, 8  # PLACE is where the shipped cell palletizes to


def cell(*crossings: tuple[str, str, str], **zones: str) -> StorageCell:
    """The shipped cell with poses in zones (`pickup="x y"`) and moves through one (from, to, zone)."""
    plain = shipped("sis_a").cells[0]

    def placed(pose: Pose) -> Pose:
        names = zones.get(pose.name.replace("-", "").replace(" ", ""), "")
        return replace(pose, zones=frozenset(names.split()))

    return replace(
        plain,
        home=placed(plain.home),
        pickup=placed(plain.pickup),
        stations=tuple(map(placed, plain.stations)),
        palletizing=Palletizing(pick=placed(plain.palletizing.pick), place=placed(plain.palletizing.place)),
        crossings=tuple(Crossing(a=a, b=b, zones=frozenset({zone})) for a, b, zone in crossings),
    )


def storage(made: StorageCell) -> list[Any]:
    way = storage_way(made, made.pickup, made.stations[STATION], made.home)
    return [(leg.start, leg.end, leg.zones) for leg in plan(made.workspaces["ra1"], way, made.pickup)]


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
def test_a_storage_way_has_these_legs(case: tuple[StorageCell, list[Any]]) -> None:
    made, legs = case
    assert storage(made) == legs


def test_a_part_that_may_have_to_go_back_needs_the_zone_of_the_pick_up() -> None:
    made = cell(pickup="x", station4="y")
    pick, place = made.stations[OTHER], made.stations[PLACE]
    assert plan(made, (made.home, pick, place), made.pickup) == [
        Leg(start=0, end=2, zones=frozenset({"x", "y"}))
    ]


def test_an_arm_that_stands_at_a_station_starts_there() -> None:
    made = cell(("station 8", "pick-up", "x"), ("home", "station 8", "y"))
    start = made.palletizing.place
    legs = plan(made, storage_way(made, made.pickup, made.stations[STATION], start), made.pickup)
    assert legs[0] == Leg(start=0, end=1, zones=frozenset({"x", "y"}))
    legs = plan(made.workspaces["ra1"], palletizing_way(made, start), made.pickup)
    assert [(leg.start, leg.end) for leg in legs] == [(0, 1), (1, 2), (2, 3)]
    assert "y" in legs[0].zones


@pytest.mark.parametrize("name", ["home", "station 8"])
def test_a_way_starts_and_ends_outside(name: str) -> None:
    made = cell(**{name.replace(" ", ""): "x"})
    with pytest.raises(ConfigError, match=f"{name} lies in zone x, so no way may start or end there"):
        plan(made.workspaces["ra1"], palletizing_way(made, made.home), made.pickup)


def test_no_problem_with_poses_outside_or_passed_through() -> None:
    assert plan_problems(cell()) == plan_problems(cell(pickup="x", station7="x y")) == {}


def test_a_home_or_a_place_in_a_zone_is_a_problem_with_its_pose() -> None:
    assert plan_problems(cell(home="x", station8="y")) == {
        "home": "cell sis_a: home lies in zone x; the arm waits there, so it must be outside all zones",
        "station 8": "cell sis_a: station 8 lies in zone y; "
        "palletizing ends and waits there, so it must be outside all zones",
    }
