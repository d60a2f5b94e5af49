"""The twin beside a plant: what is drawn solid is what the plant was told last, and parts go their way."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from arboleda.core.plant import Plant
from arboleda.dashboard.twin.twin import Twin
from arboleda.geometry import kinematics
from arboleda.geometry.bodies import Body
from arboleda.model.messages import MotionState, Report, TaskRequest, Verb
from arboleda.model.plant_model import Cell, Evidence, PlantModel
from arboleda.testing import Rig, shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda.views import twin_view
from arboleda.views.geometry import places

from ...kinds import lab


class Watched:
    """A plant and its twin."""

    def __init__(self, plant: PlantModel, drawings: dict[str, Body]) -> None:
        self.rig = Rig(plant)
        self.twin = Twin(places(plant), drawings)
        self.rig.wait(0.5)

    def frame(self) -> dict[str, Any]:
        return self.twin.frame(twin_view.positions(self.rig.plant), self.rig.now)

    def robot(self, name: str) -> dict[str, Any]:
        return self.frame()[f"robot/{name}"]

    def part(self) -> dict[str, Any] | None:
        return self.frame()["part/sis_a"]

    def full(self) -> list[str]:
        """The stations in which a part is drawn."""
        return [place for place, parts in self.frame()["books/sis_a"]["places"].items() if parts]


@pytest.fixture
def watched(drawings: dict[str, Body]) -> Watched:
    return Watched(shipped("sis_a"), drawings)


def test_what_is_drawn_solid_is_the_last_report_all_the_time(watched: Watched) -> None:
    watched.rig.submit("sis_a 0B 7")
    for _ in range(400):
        watched.rig.wait(0.05)
        drawn, belief = watched.robot("ra1"), watched.rig.plant.dispatcher.beliefs["ra1"]
        assert (drawn["kind"], drawn["q"]) == ("measured", list(belief.q))
    assert watched.rig.outcomes()


def test_a_move_shows_where_it_leads_until_it_ends(watched: Watched) -> None:
    watched.rig.submit("sis_a 0B 7")
    watched.rig.wait_for("sis_a", "move to pick-up")
    assert watched.robot("ra1")["goal"] == list(StorageLayout(watched.rig.plant.model.cells[0]).pickup.q)
    watched.rig.wait_for("sis_a", "effector on/dwell")
    assert watched.robot("ra1")["goal"] is None


def test_a_part_waits_on_the_mobile_hangs_in_the_effector_and_lies_in_its_station(watched: Watched) -> None:
    assert watched.part() is None
    watched.rig.submit("sis_a 0B 7")
    watched.rig.wait_for("sis_a", "drive path 0B")
    assert watched.part() == {"at": "mobile", "sure": False}
    watched.rig.wait_for("sis_a", "move to station 7")
    assert watched.part() == {"at": "arm", "sure": True}
    assert watched.full() == []
    watched.rig.wait_for("sis_a", "move to home")
    assert (watched.part(), watched.full()) == (None, ["station_7"])
    watched.rig.submit("sis_a 0B 3")
    watched.rig.wait(20.0)
    assert (watched.part(), watched.full()) == (None, ["station_3", "station_7"])
    assert watched.rig.operate(Verb.UNLOAD, "sis_a") is None
    assert (watched.part(), watched.full()) == (None, [])


def test_a_part_that_is_released_by_hand_is_drawn_where_the_arm_let_go(watched: Watched) -> None:
    watched.rig.submit("sis_a 0B 7")
    watched.rig.wait_for("sis_a", "move to station 7")
    watched.rig.operate(Verb.STOP)
    watched.rig.wait(3.0)
    assert watched.part() == {"at": "arm", "sure": True}
    for verb in (Verb.CLEAR, Verb.RESET, Verb.RELEASE):
        assert watched.rig.operate(verb, "sis_a") is None
        watched.rig.wait(1.0)
    part = watched.part()
    assert part is not None and part["at"] == "place"


def test_a_palletizing_part_waits_at_its_pick_pose(watched: Watched) -> None:
    watched.rig.submit("sis_a palletizing")
    watched.rig.wait(0.3)
    part = watched.part()
    assert part is not None
    assert part["frame"] == pytest.approx(watched.twin.scene["cells"][0]["pickups"][0])


def test_a_board_that_falls_silent_is_drawn_old(watched: Watched) -> None:
    watched.rig.power_off("ra_1")
    watched.rig.wait(5.0)
    drawn = watched.robot("ra1")
    assert (drawn["kind"], drawn["q"]) == ("stale", [0, 0, 0])
    assert drawn["age"] >= 4


def test_what_a_robot_that_need_not_tell_its_place_says_of_it_counts_until_it_is_stale() -> None:
    plant = Plant(shipped("sis_a", evidence=Evidence.STATE), epoch=1, now=100.0)
    plant.step(100.0, [Report(at=100.0, robot="ra1", state=MotionState.STOPPED, q=(0.0, 0.0, 0.0))])

    def reports(at: float) -> bool:
        plant.step(at, [])
        (arm,) = (row for row in twin_view.positions(plant)["robots"] if row["name"] == "ra1")
        return bool(arm["reports"])

    assert [reports(100.0 + after_s) for after_s in (0.0, 1.4, 1.6)] == [True, True, False]


def test_a_robot_that_only_says_whether_it_moves_is_estimated(drawings: dict[str, Body]) -> None:
    model = shipped("sis_a", evidence=Evidence.STATE)
    plant, twin = Plant(model, epoch=1, now=0.0), Twin(places(model), drawings)

    def told(at: float, robot: str, state: MotionState) -> None:
        while plant.now + 1.0 < at:  # a plant that does nothing for longer was away
            plant.step(plant.now + 1.0, [])
        plant.step(at, [Report(at=at, robot=robot, state=state)])

    def drawn(robot: str, at: float) -> dict[str, Any]:
        return twin.frame(twin_view.positions(plant), at)[f"robot/{robot}"]

    for robot in model.robots:
        told(0.0, robot, MotionState.STOPPED)
        assert drawn(robot, 0.0)["kind"] == "unknown"
    plant.step(1.0, [TaskRequest(at=1.0, text="sis_a 0B 7")])
    plant.step(1.3, [])
    told(2.0, "rm_sis_a", MotionState.MOVING)
    assert drawn("rm_sis_a", 2.5)["kind"] == "unknown"
    told(6.0, "rm_sis_a", MotionState.STOPPED)
    assert drawn("rm_sis_a", 6.0)["estimate"] == [0.1, 0.2]
    told(6.1, "ra1", MotionState.MOVING)
    told(8.0, "ra1", MotionState.STOPPED)
    pickup = list(StorageLayout(model.cells[0]).pickup.q)
    assert drawn("ra1", 8.0) == {
        "kind": "estimated",
        "q": None,
        "estimate": pickup,
        "goal": None,
        "age": None,
    }


def test_zones_say_who_has_them(watched: Watched) -> None:
    positions = twin_view.positions(watched.rig.plant)
    positions["zones"] = [{"zone": "centre", "state": "held", "robot": "ra1", "waiting": []}]
    assert watched.twin.frame(positions, 0.0)["zone/centre"] == {
        "state": "held",
        "robot": "ra1",
        "waiting": [],
    }


def test_robots_of_a_cell_without_a_rack_are_drawn_and_others_are_not(drawings: dict[str, Body]) -> None:
    """Two arms, one with a zone at its home, and an oven."""
    first, second, third = shipped().cells
    left, right = first.workspaces["ra1"], second.workspaces["ra2"]
    zoned = replace(left.home, zones=frozenset({"middle"}))
    left = replace(left, home=zoned, poses=(zoned, *left.poses[1:]))
    oven = lab.model().robots["oven"]
    members = (("left", left.robot), ("right", right.robot), ("oven", oven))
    pair = Cell(name="pair", queue_limit=5, members=members, spaces=(left, right))
    plant = PlantModel(name="two", cells=(pair, third), zones=("middle",))
    twin = Twin(places(plant), drawings)
    frame = twin.frame(twin_view.positions(Plant(plant, epoch=7, now=0.0)), 0.0)
    assert set(frame) == {
        *(f"robot/{name}" for name in ("ra1", "ra2", "ra3", "rm_sis_c")),
        "part/sis_c",
        "books/pair",
        "books/sis_c",
        "zone/middle",
    }
    tool = kinematics.tool(drawings["ra1"], (0.0, 0.0, 0.0), kinematics.floor(left.robot.base.on_floor))
    (low_x, low_y, _), (high_x, high_y, _) = twin.scene["bounds"]
    x, y, _ = kinematics.at(tool)
    assert low_x < x < high_x and low_y < y < high_y
    assert twin.scene["zones"][0]["outline"]
