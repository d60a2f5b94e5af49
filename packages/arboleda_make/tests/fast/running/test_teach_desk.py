"""Teaching over HTTP: buttons in degrees and millimetres, ways along axes, and targets in the draft."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest
import yaml

from arboleda.core.plant import Plant
from arboleda.geometry import bodies, kinematics
from arboleda.model.messages import Jog, Verb
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file.draft import DraftCheck
from arboleda.plant_file.loader import load
from arboleda.plant_file.urdf import robot_urdf
from arboleda.runtime import at_work
from arboleda.sim.body import SeenState
from arboleda.testing import Rig
from arboleda_make.drafts.api import DraftRefused
from arboleda_make.drafts.desk import DraftDesk
from arboleda_make.drafts.plant_folder import PlantFolder
from arboleda_make.teaching import tool_path
from arboleda_make.teaching.api import Along, Button, Target, TeachRefused
from arboleda_make.teaching.desk import TeachDesk

BEAT_S = 0.05
EDITOR = {"editor": "ana-12345", "name": "Ana"}
SHIPPED = files("arboleda").joinpath("plants/plant.yaml").read_text()
LAB = """# my lab
name: lab
uses: [rest.xml]
kinds:
  clamp:
    facts: {jaw: [open, closed]}
    verbs:
      close: {effect: switch, sets: {jaw: closed}, with: {force: [soft, hard]}}
cells:
  lab:
    devices:
      loader: {kind: arm, model: scara}
      cart:   {kind: mobile}
      clamp:  {kind: clamp}
    targets:
      home: {loader: {deg: [0, 0], mm: 0}, cart: {node: 0}}
      nest: {loader: {deg: [60, 20], mm: 80, approach_mm: 40}, cart: {node: 4}} # by eye
zones:
  inside: {poses: [lab nest]}
"""
TREE = """<root BTCPP_format="4" main_tree_to_execute="Rest">
  <BehaviorTree ID="Rest"><Sleep msec="100"/></BehaviorTree>
</root>
"""
OF_SIX = {"model: scara": "model: cr10a", "deg: [0, 0], mm: 0": "deg: [0, 0, 0, 0, 0, 0]"}
OF_SIX |= {"deg: [60, 20], mm: 80, approach_mm: 40": "deg: [60, 20, 0, 0, 0, 0]"}


class Unchecked:
    """Finds nothing wrong with any files."""

    def check(self, files: PlantFiles, plant_file: Path) -> DraftCheck:
        return DraftCheck(read=files)

    def stop(self) -> None: ...


class Line:
    """The plant of a rig, whose clock is moved by hand."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self.model = rig.plant.model

    def read(self, look: Callable[[Plant], Any]) -> Any:
        return look(self._rig.plant)

    def post(self, event: Jog) -> None:
        self._rig.tell(replace(event, at=self._rig.now))


class Lab:
    """A cell that Ana teaches, and the desk that she uses."""

    def __init__(self, folder: Path, text: str, cell: str) -> None:
        path = folder / "plant.yaml"
        path.write_text(text)
        (folder / "rest.xml").write_text(TREE)
        (folder / "state").mkdir()
        kept = PlantFiles(plant="plant.yaml", contents={"plant.yaml": text.encode()})
        at_work.keep(folder / "state", kept, "2026-11-25T20:00:00+00:00")
        self.model = load(path)
        self.rig = Rig(self.model)
        self.rig.wait(2.0)
        self.draft = DraftDesk(PlantFolder(path, folder / "state"), folder / "state", Unchecked())
        self.desk = TeachDesk(Line(self.rig), self.draft)
        self.cell, self.number = cell, 0
        assert self.rig.operate(Verb.TEACH, cell, teacher="ana") is None
        self.session = self.rig.answers[-1].act or 0

    def hold(self, seconds: float, robot: str, **towards: Any) -> dict[str, Any]:
        self.number += 1
        until, answer = self.rig.now + seconds, {}
        while self.rig.now < until:
            answer = self.desk.press(self.cell, self.button(robot, **towards))
            self.rig.wait(BEAT_S)
        return answer

    def button(self, robot: str, **towards: Any) -> Button:
        return Button(session=self.session, number=self.number, robot=robot, **towards)

    def at(self, robot: str) -> Any:
        return next(each["at"] for each in self.desk.state(self.cell)["devices"] if each["name"] == robot)

    def here(self, robot: str, target: str, **more: Any) -> dict[str, Any]:
        return self.desk.here(self.cell, Target(robot=robot, target=target, **EDITOR, **more))

    @property
    def written(self) -> Any:
        return self.draft.state()["values"]


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    return Lab(tmp_path, LAB, "lab")


def test_the_state_has_all_that_can_be_told(lab: Lab) -> None:
    state = lab.desk.state("lab")
    loader, cart, clamp = state["devices"]
    assert [(each["name"], each["unit"], each["lower"], each["upper"]) for each in loader["joints"]] == [
        ("brazo", "deg", -150, 150),
        ("antebrazo", "deg", -135, 135),
        ("efector", "mm", 0, 100),
    ]
    assert (loader["at"], loader["axes"], loader["holds"]) == ([0, 0, 0], True, True)
    assert (cart["at"], cart["nodes"], cart["axes"]) == (0, 9, False)
    assert [(each["name"], [one["choices"] for one in each["parameters"]]) for each in clamp["verbs"]] == [
        ("close", [["soft", "hard"]])
    ]
    assert {(each["name"], each["robot"]) for each in state["targets"]} == {
        (name, robot) for name in ("home", "nest") for robot in ("loader", "cart")
    }
    assert state["zones"] == ["inside"]
    assert state["teaching"]["teacher"] == "ana" and state["drafts"]


def test_a_goal_is_in_degrees_and_millimetres(lab: Lab) -> None:
    lab.hold(3.0, "loader", goal=[5.0, 0.0, 10.0])
    assert lab.at("loader") == pytest.approx([5.0, 0.0, 10.0], abs=0.4)


def test_a_press_that_cannot_be_is_refused_before_anything_moves(lab: Lab) -> None:
    lab.number = 1
    with pytest.raises(TeachRefused, match="loader cannot go there: brazo_joint goes from -150 to 150 deg"):
        lab.desk.press("lab", lab.button("loader", goal=[151.0, 0.0, 0.0]))
    with pytest.raises(TeachRefused, match="loader goes to 3 values of its joints"):
        lab.desk.press("lab", lab.button("loader", goal=4))
    with pytest.raises(TeachRefused, match="nobody is no device of lab"):
        lab.desk.press("lab", lab.button("nobody", goal=4))
    with pytest.raises(TeachRefused, match="there is no cell nowhere"):
        lab.desk.state("nowhere")
    with pytest.raises(TeachRefused, match="force of close is"):
        lab.desk.press("lab", lab.button("clamp", verb="close", values={"force": "gently"}))


def test_a_verb_of_a_device_is_carried_out(lab: Lab) -> None:
    lab.hold(0.5, "clamp", verb="close", values={"force": "soft"})
    lab.rig.wait(1.0)
    assert lab.rig.plant.dispatcher.beliefs["clamp"].fact("jaw") == "closed"


def test_here_moves_a_target_in_the_draft_and_keeps_all_else(lab: Lab) -> None:
    lab.hold(14.0, "loader", goal=[5.0, 0.0, 45.0])
    made = lab.here("loader", "nest")
    assert made["place"] == ["cells", "lab", "targets", "nest", "loader"]
    nest = lab.written["cells"]["lab"]["targets"]["nest"]
    turn, elbow, mm = lab.at("loader")
    assert nest["loader"] == {"deg": [turn, elbow], "mm": mm, "approach_mm": 40}
    assert nest["cart"] == {"node": 4}
    drafted = [each for each in lab.desk.state("lab")["targets"] if each["draft"]]
    assert [(each["name"], each["robot"], each["at"]) for each in drafted] == [
        ("nest", "loader", lab.at("loader"))
    ]
    assert lab.draft.state()["editor"]["name"] == "Ana"


def test_here_makes_a_target_with_approach_and_zone(lab: Lab) -> None:
    lab.here("loader", "spare", approach_mm=0.0, zone="inside")
    lab.here("cart", "spare")
    written = lab.written
    assert written["cells"]["lab"]["targets"]["spare"] == {
        "loader": {"deg": [0.0, 0.0], "mm": 0.0},
        "cart": {"node": 0},
    }
    assert written["zones"]["inside"]["poses"] == ["lab nest", "lab spare"]


def test_what_cannot_be_a_target_is_refused_and_changes_nothing(lab: Lab) -> None:
    for name, why in (("a b", "a letter"), ("ñ", "a letter"), ("a" * 61, "a letter")):
        with pytest.raises(TeachRefused, match=why):
            lab.here("loader", name)
    with pytest.raises(TeachRefused, match="no joint that slides up and down"):
        lab.here("cart", "spare", approach_mm=10.0)
    with pytest.raises(TeachRefused, match="can go up 0 mm from here, so an approach of 20 mm cannot be"):
        lab.here("loader", "spare", approach_mm=20.0)
    with pytest.raises(TeachRefused, match="an approach of 40 mm cannot be"):  # which the target has
        lab.here("loader", "nest")
    with pytest.raises(TeachRefused, match="no zone outside; there are inside"):
        lab.here("loader", "spare", zone="outside")
    lab.draft.take("ben-12345", "Ben")
    with pytest.raises(DraftRefused, match="Ben edits this draft"):
        lab.here("loader", "spare")
    assert lab.draft.state()["changes"] == []


def test_a_robot_that_was_moved_by_hand_is_read_as_well(lab: Lab) -> None:
    board = lab.rig.boards["loader"]
    board.body.place(SeenState(q=(0.2, 0.4, 0.0)), holds=False)
    lab.rig.wait(1.0)
    lab.here("loader", "spare")
    written = lab.written["cells"]["lab"]["targets"]["spare"]["loader"]
    assert written["deg"] == lab.at("loader")[:2] and written["deg"] != [0.0, 0.0]


def test_the_drafted_target_is_one_that_check_takes(lab: Lab, tmp_path: Path) -> None:
    lab.hold(3.0, "loader", goal=[5.0, 0.0, 10.0])
    lab.here("loader", "spare", approach_mm=5.0)
    other = tmp_path / "other.yaml"
    other.write_text(yaml.safe_dump(lab.written))
    pose = load(other).cell("lab").reach["loader"].by_name["spare"]
    assert math.degrees(pose.joints[0]) == lab.at("loader")[0] and pose.above is not None


def test_the_short_form_of_a_cell_has_its_own_places(tmp_path: Path) -> None:
    lab = Lab(tmp_path, SHIPPED, "sis_a")
    assert lab.here("ra1", "home")["place"] == ["cells", "sis_a", "home"]
    assert lab.here("ra1", "pickup_A")["place"] == ["cells", "sis_a", "pickups", "A"]
    with pytest.raises(TeachRefused, match="the arm is taught at home, pickup and pickup_EXIT"):
        lab.here("ra1", "station_7")


@pytest.mark.parametrize("frame", ["base", "tool"])
@pytest.mark.parametrize(("axis", "row"), [("x", 0), ("y", 1), ("z", 2)])
def test_a_way_along_an_axis_of_a_scara_keeps_to_it(lab: Lab, axis: str, row: int, frame: str) -> None:
    body = bodies.read(robot_urdf(lab.model, "loader"))
    q = (0.6, 0.8, 0.05)
    before = kinematics.tool(body, q)
    after = kinematics.tool(body, tool_path.moved(body, q, axis=axis, frame=frame, metres=1e-3))
    way = [before[k][row] if frame == "tool" else float(k == row) for k in range(3)]
    assert [after[k][3] - before[k][3] for k in range(3)] == pytest.approx(
        [1e-3 * each for each in way], abs=2e-5
    )


def test_a_way_of_an_arm_of_six_joints_keeps_its_tool_as_it_is_turned(tmp_path: Path) -> None:
    text = LAB
    for scara, six in OF_SIX.items():
        text = text.replace(scara, six)
    lab = Lab(tmp_path, text, "lab")
    body = bodies.read(robot_urdf(lab.model, "loader"))
    q = (0.3, -0.5, 1.2, 0.2, 1.0, 0.1)
    before = kinematics.tool(body, q)
    after = kinematics.tool(body, tool_path.moved(body, q, axis="z", frame="base", metres=1e-3))
    assert [after[k][3] - before[k][3] for k in range(3)] == pytest.approx([0, 0, 1e-3], abs=2e-5)
    turned = [after[row][column] - before[row][column] for row in range(3) for column in range(3)]
    assert max(map(abs, turned)) < 1e-4


def test_a_step_along_an_axis_ends_where_it_should(lab: Lab) -> None:
    lab.hold(9.0, "loader", goal=[30.0, 30.0, 20.0])
    lab.hold(3.0, "loader", along=Along(axis="z", sign=-1, mm=10.0))
    assert lab.at("loader")[2] == pytest.approx(30.0, abs=0.4)
