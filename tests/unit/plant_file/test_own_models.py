"""Arms from a URDF or a YAML beside the plant file: what they become, and how they are printed and drawn."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.geometry import bodies, kinematics
from arboleda.geometry.bodies import Body
from arboleda.geometry.kinematics import Point
from arboleda.model.messages import MotionState
from arboleda.model.plant_model import PlantModel
from arboleda.plant_check import layout_check
from arboleda.plant_file import loader
from arboleda.plant_file.robot_models import arm_models
from arboleda.plant_file.urdf import robot_urdf, root_link
from arboleda.testing.storage_layout import StorageLayout
from arboleda.wire import payloads, units
from arboleda.wire.values import Telemetry

from .own_arms import GANTRY, ONE, SLIDE, TENDER, arm, gantry, joint, link, robot, swing, tender, written

EXAMPLE = TENDER.parents[2] / "plants/own_arm.yaml"
CR10A = Path(__file__).parents[3] / "src/arboleda_description/arboleda_description/robots/cr10a.yaml"


def body(plant: PlantModel) -> Body:
    return bodies.read(robot_urdf(plant, "ra"))


def tool(plant: PlantModel, *q: float) -> tuple[float, ...]:
    return kinematics.at(kinematics.tool(body(plant), q))


def test_six_joints_come_from_a_urdf_in_their_order(tmp_path: Path) -> None:
    joints = arm(tender(tmp_path)).joints
    assert [each.name for each in joints] == ["waist", "shoulder", "elbow", "roll", "wrist", "flange"]
    assert (joints[1].lower, joints[1].upper, joints[1].speed, joints[1].unit) == (-1.6, 1.9, 2.4, "rad")
    assert (joints[5].lower, joints[5].upper) == (-2 * math.pi, 2 * math.pi), "it turns without end"


def test_what_a_urdf_does_not_say_is_assumed_and_said(tmp_path: Path) -> None:
    plant = tender(tmp_path)
    assert {each.step for each in arm(plant).joints} == {math.radians(0.01)}
    assert [each.acceleration for each in arm(plant).joints[:2]] == [2 * 2.6, 2 * 2.4]
    said = " ".join(loader.notes(plant))
    assert "full speed in 0.5 s are assumed for q1, q2, q3, q4, q5, q6" in said
    assert "motor steps of 0.01 deg or 0.1 mm are assumed for q1" in said
    assert "the joint flange has no ends; it is taken as -360 deg to 360 deg" in said


SPEEDLESS = {
    "a velocity of 0, as exporters write it": ONE.replace('velocity="2"', 'velocity="0"'),
    "no velocity": ONE.replace('velocity="2"', ""),
    "no limit and no ends": robot(
        link("post"), link("beam"), joint("swing", "post beam", "continuous", limit="")
    ),
}


@pytest.mark.parametrize("urdf", SPEEDLESS.values(), ids=SPEEDLESS)
def test_a_speed_that_a_urdf_leaves_open_is_that_of_the_plant_file(tmp_path: Path, urdf: str) -> None:
    (swinging,) = arm(swing(tmp_path, urdf, more=", speeds: {q1_deg_s: 90}")).joints
    assert swinging.speed == pytest.approx(math.radians(90))
    assert swinging.acceleration == pytest.approx(math.radians(180)), "to full speed in 0.5 s"


def test_fingers_beside_the_chain_may_follow_each_other(tmp_path: Path) -> None:
    fingers = [joint(f"f{n}", f"beam finger{n}", "prismatic", limit=SLIDE) for n in "ab"]
    hand = fingers[0] + fingers[1].replace("</joint>", '<mimic joint="fa"/></joint>')
    urdf = ONE.replace("</robot>", f"{link('fingera')}{link('fingerb')}{hand}</robot>")
    plant = swing(tmp_path, urdf, "{file: one.urdf, tip_link: beam}")
    assert [each.name for each in arm(plant).joints] == ["swing"]
    assert any(
        "the joint fb is not on the way to the tool and stays at 0" in each for each in loader.notes(plant)
    )
    assert "mimic" not in robot_urdf(plant, "ra"), "a fixed joint follows nothing"


def test_a_cylinder_that_follows_a_joint_of_the_arm_is_no_second_end(tmp_path: Path) -> None:
    urdf = robot(
        *map(link, ("post", "beam", "wrist", "piston")),
        joint("swing", "post beam"),
        joint("turn", "beam wrist"),
        joint("balance", "post piston", more='<mimic joint="swing"/>'),
    )
    (tmp_path / "one.urdf").write_text(urdf)
    poses = ("{deg: [0, 0]}", "{deg: [30, 0]}", "{0: {deg: [-30, 0]}}")
    assert [each.name for each in arm(loader.load(written(tmp_path, "one.urdf", poses))).joints] == [
        "swing",
        "turn",
    ]


def test_what_a_maker_leaves_in_a_urdf_and_nothing_uses_does_no_harm(tmp_path: Path) -> None:
    urdf = ONE.replace(
        link("post"), '<xacro:property name="width" value=".2"/>' + link("post", '<box size="0 0 0"/>')
    )
    urdf = urdf.replace("<robot", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"').replace(
        '"post"', '"/post"'
    )
    assert body(swing(tmp_path, urdf))["link"] == "ra_base_link"


def test_it_is_said_of_an_arm_among_devices_too() -> None:
    said = loader.notes(loader.load(TENDER.parents[1] / "plant.yaml"))
    assert [each.split(":")[0] for each in said] == ["tender"] * len(said)
    assert any("full speed in 0.5 s are assumed for q3, q4, q5, q6" in each for each in said)


def test_the_plant_file_says_it_better(tmp_path: Path) -> None:
    model = f"{{file: {TENDER}, accelerations: {{q2_deg_s2: 90}}, steps: {{q1_deg: 0.1}}}}"
    more = ", limits: {q1_deg: [-100, 120]}, speeds: {q3_deg_s: 45}"
    plant = tender(tmp_path, model, more)
    q1, q2, q3 = arm(plant).joints[:3]
    assert (q2.acceleration, q1.step, q3.speed) == tuple(map(math.radians, (90, 0.1, 45)))
    assert (q1.lower, q1.upper) == (math.radians(-100), math.radians(120))
    said = " ".join(loader.notes(plant))
    assert "assumed for q1, q3, q4, q5, q6;" in said and "assumed for q2, q3, q4, q5, q6;" in said


def test_sliding_joints_have_their_millimetres_in_a_list(tmp_path: Path) -> None:
    plant = gantry(tmp_path)
    cell = plant.cells[0]
    layout = StorageLayout(cell)
    assert layout.pickup.q == pytest.approx((0.1, 0.2, -0.25))
    assert units.to_wire(layout.arm.joints[0], 0.25) == pytest.approx(250), "on MQTT a millimetre is a degree"


def test_an_approach_lifts_by_the_last_joint_that_slides_up_and_down(tmp_path: Path) -> None:
    plant = gantry(tmp_path)
    assert [each.up for each in arm(plant).joints] == [0, 0, 1]
    assert plant.cells[0].stations[0].above == pytest.approx((0.4, 0.05, -0.21))


def test_a_sliding_joint_that_hangs_upside_down_lifts_the_other_way(tmp_path: Path) -> None:
    turned = "{file: gantry.urdf, mount: {xyz_mm: [0, 0, 1500], rpy_deg: [180, 0, 0]}}"
    plant = gantry(tmp_path, turned)
    assert [each.up for each in arm(plant).joints] == [0, 0, -1]
    assert plant.cells[0].stations[0].above == pytest.approx((0.4, 0.05, -0.29))


def test_a_slide_on_an_arm_that_tilts_lifts_nothing_for_sure(tmp_path: Path) -> None:
    tilts = robot(
        *map(link, "abc"), joint("tilt", "a b", axis="0 1 0"), joint("out", "b c", "prismatic", limit=SLIDE)
    )
    poses = ("{deg: [0], mm: 0}", "{deg: [30], mm: 100}", "{0: {deg: [5], mm: 100, approach_mm: 20}}")
    (tmp_path / "tilts.urdf").write_text(tilts)
    with pytest.raises(Exception, match=r"needs a joint that slides up and down; the tilts.urdf has none"):
        loader.load(written(tmp_path, "tilts.urdf", poses))


def test_recovery_lifts_the_way_that_is_up(tmp_path: Path) -> None:
    q3 = arm(gantry(tmp_path)).joints[2]
    assert (q3.higher(-0.25, -0.21, -0.23), q3.higher(0.1, -0.21)) == (-0.21, 0.1)
    assert arm_models()["scara"].joints[2].higher(0.08, 0.02) == 0.02
    assert arm(gantry(tmp_path)).joints[0].higher(0.1, 0.4) == 0.1


def test_it_is_printed_with_its_prefix_limits_and_speeds(tmp_path: Path) -> None:
    more = ", twin: left, limits: {q1_deg: [-100, 120]}, speeds: {q1_deg_s: 45}"
    printed = ElementTree.fromstring(robot_urdf(tender(tmp_path, more=more), "ra"))
    names = [each.get("name", "") for each in (*printed.iter("link"), *printed.findall("joint"))]
    assert all(name.startswith("left_") for name in names) and "left_waist" in names
    limits = {each.get("name"): each.find("limit") for each in printed.findall("joint")}
    found = [float(limits["left_waist"].get(key, "")) for key in ("lower", "upper", "velocity")]
    assert found == [math.radians(value) for value in (-100, 120, 45)]
    flange = next(each for each in printed.findall("joint") if each.get("name") == "left_flange")
    assert flange.get("type") == "revolute", "it has ends here"


def test_it_begins_at_base_link_and_ends_at_tool0(tmp_path: Path) -> None:
    plant = tender(tmp_path)
    assert body(plant)["link"] == root_link(arm(plant)) == "ra_base_link"
    assert bodies.tip(body(plant)) == "ra_tool0"
    assert tool(plant, *[0.0] * 6) == pytest.approx((0, 0, 0.32 + 0.38 + 0.38 + 0.10))


def test_a_mount_and_a_tool_move_the_tool(tmp_path: Path) -> None:
    mount, end = "mount: {xyz_mm: [0, 0, 400], rpy_deg: [0, 0, 90]}", "tool: {xyz_mm: [0, 0, 30]}"
    model = f"{{file: {TENDER}, {mount}, {end}}}"
    plant = tender(tmp_path, model)
    bent = (0, math.pi / 2, 0, 0, 0, 0)
    assert tool(plant, *bent) == pytest.approx((0, 0.38 + 0.38 + 0.13, 0.4 + 0.32), abs=1e-9)


def test_links_of_the_file_that_have_our_names_keep_their_places(tmp_path: Path) -> None:
    urdf = robot(link("base_link"), link("tool0"), link("cup"), joint("swing", "base_link tool0"))
    urdf = urdf.replace("</robot>", joint("on", "tool0 cup", "fixed", limit="") + "</robot>")
    plant = swing(tmp_path, urdf, "{file: one.urdf, tip_link: cup, mount: {xyz_mm: [0, 0, 50]}}")
    chain = [each["link"] for each in bodies.tool_chain(body(plant))]
    assert chain == ["ra_base_link", "ra_base_link_of_model", "ra_tool0_of_model", "ra_cup", "ra_tool0"]


def test_fixed_links_beside_the_way_are_drawn_and_move_along(tmp_path: Path) -> None:
    urdf = ONE.replace("</robot>", link("camera", '<sphere radius="0.02"/>') + "</robot>")
    urdf = urdf.replace(
        "</robot>", joint("eye", "beam camera", "fixed", limit="", xyz="0.1 0 0") + "</robot>"
    )
    plant = swing(tmp_path, urdf, "{file: one.urdf, tip_link: beam}")
    frames = kinematics.place(body(plant), (math.pi / 2,))
    assert kinematics.at(frames["ra_camera"]) == pytest.approx((0, 0.1, 0.3), abs=1e-9)


def test_joints_beside_the_way_stay_at_0_and_that_is_said(tmp_path: Path) -> None:
    urdf = ONE.replace("</robot>", link("finger") + joint("grasp", "beam finger") + link("cup") + "</robot>")
    urdf = urdf.replace("</robot>", joint("on", "beam cup", "fixed", limit="") + "</robot>")
    plant = swing(tmp_path, urdf, "{file: one.urdf, tip_link: cup}")
    assert [each.name for each in arm(plant).joints] == ["swing"]
    assert "ra: one.urdf: the joint grasp is not on the way to the tool and stays at 0" in loader.notes(plant)
    assert body(plant)["children"][0]["children"][0]["children"][0]["moves"] is None


def test_an_arm_may_begin_in_the_middle_of_a_file(tmp_path: Path) -> None:
    urdf = robot(
        *map(link, ("hall", "post", "beam")), joint("rail", "hall post"), joint("swing", "post beam")
    )
    plant = swing(tmp_path, urdf, "{file: one.urdf, base_link: post}")
    assert [each.name for each in arm(plant).joints] == ["swing"]
    assert "hall" not in robot_urdf(plant, "ra")


def test_an_arm_without_a_shape_is_drawn_by_stand_ins(tmp_path: Path) -> None:
    shapes = [shape["kind"] for each in bodies.links(body(swing(tmp_path))) for shape in each["shapes"]]
    assert "cylinder" in shapes and "sphere" in shapes


def test_a_gantry_without_a_shape_is_drawn_by_its_rails(tmp_path: Path) -> None:
    turned = robot(
        *map(link, ("frame", "x", "y", "z")),
        joint("along", "frame x", "prismatic", "1 0 0", SLIDE, xyz="0 0 1"),
        joint("across", "x y", "prismatic", "1 0 0", SLIDE, xyz="0 0 0").replace(
            '<origin xyz="0 0 0"/>', f'<origin xyz="0 0 0" rpy="0 0 {math.pi / 2}"/>'
        ),
        joint("up", "y z", "prismatic", "0 0 1", 'lower="-0.3" upper="0.2" velocity="0.3"', xyz="0 0 0"),
    )
    (tmp_path / "gantry.urdf").write_text(turned)
    poses = ("{mm: [0, 0, 0]}", "{mm: [100, 200, -250]}", "{0: {mm: [400, 50, -250], approach_mm: 40}}")
    plant = loader.load(written(tmp_path, "gantry.urdf", poses))
    drawn = {each["link"]: each["shapes"] for each in bodies.links(body(plant))}
    rails = {
        name: [rounded(ends(shape)) for shape in shapes if shape["kind"] == "cylinder"]
        for name, shapes in drawn.items()
    }
    post, along = rails["ra_frame"]
    assert (post, along) == (((0, 0, 0), (0, 0, 1)), ((0, 0, 1), (0.5, 0, 1)))
    assert rails["ra_x"] == [((0, 0, 0), (0, 0.5, 0))]
    assert rails["ra_y"] == [((0, 0, -0.3), (0, 0, 0.2))]
    assert all(shapes for name, shapes in drawn.items() if name not in ("ra_base_link", "ra_tool0"))


def ends(tube: dict[str, Any]) -> tuple[Point, Point]:
    frame, half = kinematics.pose(tube["xyz"], tube["rpy"]), tube["size"][1] / 2
    return kinematics.at(frame, (0, 0, -half)), kinematics.at(frame, (0, 0, half))


def rounded(points: tuple[Point, Point]) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(round(value, 6) + 0.0 for value in point) for point in points)


def test_a_mesh_stays_in_the_urdf_and_is_said_to_have_a_stand_in(tmp_path: Path) -> None:
    plant = swing(
        tmp_path, ONE.replace(link("beam"), link("beam", '<mesh filename="package://m/beam.stl"/>'))
    )
    assert 'filename="package://m/beam.stl"' in robot_urdf(plant, "ra")
    assert "ra: one.urdf: the twin draws a stand-in for the meshes of beam" in loader.notes(plant)
    assert [each["kind"] for each in body(plant)["children"][0]["children"][0]["shapes"]] == ["sphere"]


def test_a_mesh_beside_the_file_is_found_from_everywhere(tmp_path: Path) -> None:
    mesh = '<mesh filename="meshes/my beam.stl"/>'
    printed = robot_urdf(swing(tmp_path, ONE.replace(link("beam"), link("beam", mesh))), "ra")
    assert f'filename="{(tmp_path / "meshes/my beam.stl").as_uri()}"' in printed


def test_a_yaml_in_the_form_of_the_packaged_ones_is_an_arm(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(CR10A.read_text().replace("step_deg: 0.01", "step_deg: 0.02"))
    poses = ("{deg: [0, 0, 0, 0, 0, 0]}", "{deg: [1, 0, 0, 0, 0, 0]}", "{0: {deg: [2, 0, 0, 0, 0, 0]}}")
    plant = loader.load(written(tmp_path, "mine.yaml", poses))
    packaged = arm_models()["cr10a"].joints
    assert [each.step for each in arm(plant).joints] == [math.radians(0.02)] * 6
    assert [each.upper for each in arm(plant).joints] == [each.upper for each in packaged]
    assert loader.notes(plant) == ()
    other = written(tmp_path, "cr10a", poses)
    q = (0.3, -0.5, 1.0, 0.2, -0.4, 0.1)
    assert tool(plant, *q) == pytest.approx(tool(loader.load(other), *q), abs=1e-6)


def test_a_yaml_needs_joints_only(tmp_path: Path) -> None:
    (tmp_path / "one.yaml").write_text(
        "joints:\n"
        "- {name: lift, type: prismatic, limits_mm: [0, 300], speed_mm_s: 90, acceleration_mm_s2: 80,\n"
        "   step_deg: 0.1}\n"
        "- {name: spin, type: continuous, speed_deg_s: 90, acceleration_deg_s2: 80, step_deg: 0.1}\n"
    )
    poses = ("{deg: [0], mm: 0}", "{deg: [300], mm: 80}", "{0: {deg: [-300], mm: 80}}")
    lift, spin = arm(loader.load(written(tmp_path, "one.yaml", poses))).joints
    assert (lift.step, lift.up) == (pytest.approx(0.0001), 1)
    assert (spin.lower, spin.upper) == (-2 * math.pi, 2 * math.pi)


def test_twelve_joints_at_their_ends_fit_one_message(tmp_path: Path) -> None:
    names = [f"l{number}" for number in range(13)]
    far = 'lower="-1745" upper="1745" velocity="20"'
    joints = [joint(f"j{number}", f"{a} {b}", limit=far) for number, (a, b) in enumerate(pairwise(names))]
    twelve = ", ".join("0" * 12)
    poses = (f"{{deg: [{twelve}]}}", f"{{deg: [{twelve}]}}", f"{{0: {{deg: [{twelve}]}}}}")
    (tmp_path / "long.urdf").write_text(robot(*map(link, names), *joints))
    axes = arm(loader.load(written(tmp_path, "long.urdf", poses))).joints
    most = 2**32 - 1
    said = Telemetry(
        q_deg=tuple(units.to_wire(each, each.lower) for each in axes),
        node=None,
        state=MotionState.STOP_LATCHED,
        seq=most,
        ack_epoch=most,
        ack=most,
        done=most,
        refusal="retenido",
        refused_seq=most,
        boot_id=most,
        homed=True,
        effector=True,
        piece=True,
    )
    assert len(payloads.encode(said)) <= 512


def test_the_example_is_checked_and_says_what_it_assumes() -> None:
    said = CliRunner().invoke(cli, ["check", str(EXAMPLE)])
    assert said.exit_code == 0 and "warning" not in said.output
    assert "note: tender: tender.urdf: the joint flange has no ends" in " ".join(said.output.split())


def test_what_stands_where_is_checked_for_a_gantry_too(tmp_path: Path) -> None:
    (said, *_) = layout_check.warnings(gantry(tmp_path))
    assert "a: node 7 is out of reach" in said and "ra reaches" in said


def test_a_plant_file_says_its_models_from_where_it_lies(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    inner = tmp_path / "inner"
    inner.mkdir()
    gantry(inner)
    monkeypatch.chdir(tmp_path)
    assert len(arm(loader.load(Path("inner/plant.yaml"))).joints) == 3
    assert (inner / "gantry.urdf").read_text() == GANTRY
