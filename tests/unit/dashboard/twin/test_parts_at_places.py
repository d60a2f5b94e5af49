"""Parts of a cell with places, as the twin draws them: what its books say, in hands and at places."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from arboleda.dashboard.twin.twin import Twin
from arboleda.geometry import bodies, kinematics
from arboleda.geometry.bodies import Body
from arboleda.model.plant_model import Place
from arboleda.model.verbs import Verb
from arboleda.plant_file.urdf import robot_urdf
from arboleda.recorder.motion import key_of
from arboleda.recorder.rows import positions_of, rows_of
from arboleda.testing import Rig, shipped
from arboleda.views import twin_view
from arboleda.views.geometry import places

from ...kinds.test_places import Lab

TO_BIN = 'take("rack_1"), put("bin"), take("rack_2"), put("bin")'


class DrawnLab:
    """Lab and its twin."""

    def __init__(self, folder: Path, body: str) -> None:
        self.lab = Lab(folder, body)
        self.bench = self.lab.bench
        self.model = self.bench.plant.model
        self.body = bodies.read(robot_urdf(self.model, "mover"))
        self.twin = Twin(places(self.model), {"mover": self.body})

    def books(self) -> dict[str, Any]:
        found: dict[str, Any] = self.twin.still(self.positions())["books/lab"]
        return found

    def positions(self) -> dict[str, Any]:
        return {"now": self.bench.now, **twin_view.positions(self.bench.plant)}


def test_a_place_is_where_the_tool_of_its_robot_takes_parts(tmp_path: Path) -> None:
    drawn = DrawnLab(tmp_path, TO_BIN)
    (mover,) = drawn.model.cells[0].spaces
    found = {spot["place"]: spot for spot in drawn.twin.scene["places"]}
    assert list(found) == ["rack_1", "rack_2", "nest", "inside", "bin"]
    base = kinematics.floor(drawn.twin.scene["robots"][0]["at"])
    for name, spot in found.items():
        tool = kinematics.tool(drawn.body, mover.targets[name].joints, base)
        assert (spot["cell"], spot["frame"]) == ("lab", kinematics.flat(tool))
    low, high = drawn.twin.scene["bounds"]
    x, y, z = found["nest"]["frame"][3], found["nest"]["frame"][7], found["nest"]["frame"][11]
    assert low[0] < x < high[0] and low[1] < y < high[1] and low[2] < z < high[2]


def test_each_target_of_a_robot_is_where_its_tool_is_there(tmp_path: Path) -> None:
    drawn = DrawnLab(tmp_path, TO_BIN)
    (mover,) = drawn.model.cells[0].spaces
    found = {target["name"]: target for target in drawn.twin.scene["targets"]}
    assert list(found) == list(mover.targets)
    base = kinematics.floor(drawn.twin.scene["robots"][0]["at"])
    for name, target in found.items():
        tool = kinematics.tool(drawn.body, mover.targets[name].joints, base)
        assert (target["cell"], target["role"]) == ("lab", "mover")
        assert target["at"] == pytest.approx(kinematics.at(tool), abs=1e-4)


def test_a_record_of_before_has_no_targets_to_draw(tmp_path: Path) -> None:
    drawn = DrawnLab(tmp_path, TO_BIN)
    before = {key: told for key, told in places(drawn.model).items() if key != "targets"}
    assert Twin(before, {"mover": drawn.body}).scene["targets"] == []


def test_parts_are_drawn_where_the_books_have_them_all_the_time(tmp_path: Path) -> None:
    drawn = DrawnLab(tmp_path, TO_BIN)
    drawn.bench.submit("lab try")
    seen = []
    for _ in range(2000):
        drawn.bench.wait(0.05)
        books = drawn.books()
        assert books["places"] == drawn.lab.places.counts
        seen += [books] if books not in seen else []
        if drawn.bench.changes[-1].state.value == "done":
            break
    ways = [(each["places"]["rack_1"], each["places"]["bin"], each["carriers"]) for each in seen]
    assert ways[-7:] == [
        (1, 0, {}),
        (0, 0, {"mover": False}),
        (0, 0, {"mover": True}),
        (0, 1, {}),
        (0, 1, {"mover": False}),
        (0, 1, {"mover": True}),
        (0, 2, {}),
    ]


def test_what_a_person_says_is_drawn(tmp_path: Path) -> None:
    drawn = DrawnLab(tmp_path, "mover.home()")
    assert drawn.books()["places"]["nest"] == 0
    assert drawn.bench.operate(Verb.LOAD, "lab", place="nest") is None
    assert drawn.books()["places"]["nest"] == 1
    assert drawn.bench.operate(Verb.UNLOAD, "lab", place="nest") is None
    assert drawn.books()["places"]["nest"] == 0


PLACES = [f"station_{number}" for number in range(9)]
OF_0_1: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"stored": []}, {"places": {}, "carriers": {}}),
    ({"stored": [0, 7]}, {"places": {"station_0": 1, "station_7": 1}, "carriers": {}}),
    (
        {"stored": [], "books": {"places": {"nest": 1}, "carriers": {}}},
        {"places": {"nest": 1}, "carriers": {}},
    ),
]


def recorded(drawn: DrawnLab) -> dict[str, Any]:
    """The rows of a record."""
    rows = dict(rows_of(drawn.bench.snapshot(), drawn.positions()))
    still = {"q": None, "node": None, "fresh": [], "heard_at": None, "position_at": None}
    return rows | {key_of(robot): still for robot in drawn.model.robots}


def test_a_record_has_the_parts_that_were_drawn(tmp_path: Path) -> None:
    drawn = DrawnLab(tmp_path, TO_BIN)
    assert drawn.lab.run() is None
    assert positions_of(recorded(drawn), drawn.bench.now)["books"] == drawn.positions()["books"]


@pytest.mark.parametrize(("row", "books"), OF_0_1)
def test_a_record_of_an_earlier_version_has_the_parts_in_its_rack(
    tmp_path: Path, row: dict[str, Any], books: dict[str, Any]
) -> None:
    drawn = DrawnLab(tmp_path, TO_BIN)
    rows = recorded(drawn) | {"parts/lab": {"part": None, **row}}
    assert positions_of(rows, drawn.bench.now)["books"] == {"lab": books}


def test_where_a_cell_declares_places_nothing_else_says_where_its_parts_are(
    drawings: dict[str, Body],
) -> None:
    plant = shipped("sis_a")
    cell = replace(plant.cells[0], places=(Place(target="station_7"),))
    model = replace(plant, cells=(cell,))
    rig, twin = Rig(model), Twin(places(model), drawings)
    rig.wait(0.5)
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to station 7")
    frame = twin.frame(twin_view.positions(rig.plant), rig.now)
    assert frame["part/sis_a"] is None
    assert frame["books/sis_a"] == {"places": dict.fromkeys(PLACES, 0), "carriers": {"ra1": True}}
    rig.wait(20.0)
    frame = twin.frame(twin_view.positions(rig.plant), rig.now)
    assert frame["part/sis_a"] is None
    assert frame["books/sis_a"] == {"places": {**dict.fromkeys(PLACES, 0), "station_7": 1}, "carriers": {}}
