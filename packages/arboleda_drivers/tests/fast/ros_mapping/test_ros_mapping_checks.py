"""Mappings of ROS 2 in a plant file: what is wrong is told with its place and what to write."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
from tests.packages import ROOT

from arboleda.drivers import DriverError, Evidence, OnStop
from arboleda.model.errors import ConfigError
from arboleda.plant_file import drivers
from arboleda.plant_file.loader import load
from arboleda_drivers.paths import FIELD, field_at, steps
from arboleda_drivers.ros_mapping.keys import Call, Qos, Verb
from arboleda_drivers.ros_mapping.settings import Settings
from arboleda_drivers.ros_mapping.types import message_of

from .rover import rover

GRIP = "fields: {data: {value: $on, words: {open: false, closed: true}}}"
TAKE = "take: {service: /look, type: std_srvs/srv/SetBool, fields: {data: $on}}"
LOOK = "look: {service: /look, type: std_srvs/srv/SetBool, answer: {field: message}}"
X = "x: {topic: pose, type: turtles_msgs/msg/Pose, field: x, near: 0.1, silent_s: 2}"
SPACE = "            namespace: /rover\n"
FINISH = "at_most_s: 9, on_stop: finish}"


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (
            TAKE,
            TAKE.replace("take", "tkae"),
            "verbs.tkae: a rover has no verb tkae; there are go, grip, take, look, horn; did you mean take?",
        ),
        (TAKE, TAKE.replace("/look", "''"), "verbs.take: give one of action, service and publish"),
        (
            TAKE,
            TAKE.replace("srv/", "msg/"),
            "type is std_srvs/msg/SetBool; it is written as std_srvs/srv/Tri",
        ),
        (
            TAKE,
            TAKE.replace("SetBool", "SetBol"),
            "std_srvs has no type srv/SetBol; there are Empty, SetBool, Trigger; did you mean SetBool?",
        ),
        (
            TAKE,
            TAKE.replace("std_srvs", "st_srvs"),
            "no message package st_srvs here; did you mean std_srvs?",
        ),
        (
            TAKE,
            TAKE.replace("data:", "date:"),
            "SetBool_Request has no field date; there are data; did you mean data?",
        ),
        (TAKE, TAKE.replace("$on", "3"), "data is 3, and its type is boolean"),
        (TAKE, TAKE.replace("$on", "$off"), "fields.data: take has no parameter off; there are on"),
        (GRIP, GRIP.replace("open: false, ", ""), "verbs.grip: there is no word open; there are closed"),
        (LOOK, LOOK.replace(", answer: {field: message}", ""), "look is a query: say which field"),
        (LOOK, LOOK.replace("field: message", "field: massage"), "SetBool_Response has no field massage"),
        (LOOK, LOOK.replace("field: message", "field: message.x"), "message.x goes on after a value"),
        (X, X.replace("field: x, ", ""), "facts.x: topic, type and field go together"),
        (X, X.replace("turtles_msgs/msg/Pose", "geometry_msgs/msg/Pose"), "Pose has no field x"),
        (
            X,
            X.replace("turtles_msgs/msg/Pose, field: x", "geometry_msgs/msg/Pose, field: position"),
            "position is a Point; name a field of it: x, y, z",
        ),
        (X, X.replace("near: 0.1", "near: 0.1, feedback: y"), "give one of topic, feedback, result and done"),
        (
            "{feedback: distance}",
            "{feedback: distance, verb: grip}",
            "grip is no action, and has no feedback",
        ),
        ("{feedback: distance}", "{result: code}", "say of which verb this is the result, verb: NAME"),
        (FINISH, "at_most_s: 9}", "halt: grip could not be stopped, as only an action has a cancel"),
        (SPACE, f"{SPACE}            answer_s: 0\n", "answer_s is 0; allowed: 0.1 to 60"),
    ],
)
def test_what_is_wrong_has_its_place_and_a_hint(tmp_path: Path, old: str, new: str, told: str) -> None:
    with pytest.raises(ConfigError) as raised:
        rover(tmp_path, old, new)
    assert told in str(raised.value)


def test_work_of_a_service_can_have_a_stop_of_its_own_or_none(tmp_path: Path) -> None:
    device = rover(tmp_path)
    assert device.driver is not None and isinstance(device.driver.settings, Settings)
    settings = device.driver.settings
    kind = replace(
        device.kind,
        verbs={**device.kind.verbs, "grip": replace(device.kind.verbs["grip"], on_stop=OnStop.HALT)},
    )
    halted, halt = replace(device, kind=kind), Call(publish="/halt", type="std_msgs/msg/Empty")
    assert any("grip could not be stopped" in told for _, told in settings.problems(halted))
    assert list(replace(settings, halt=halt).problems(halted)) == []
    assert list(settings.problems(replace(halted, has_stop=False))) == []


def test_work_that_is_published_is_proven_by_facts_of_topics_or_not_at_all(tmp_path: Path) -> None:
    device = rover(tmp_path)
    assert device.driver is not None and isinstance(device.driver.settings, Settings)
    go = Verb(publish="go", type="rover_msgs/msg/Go", qos=Qos(durability="transient_local"))
    grip = Verb(publish="grip", type="rover_msgs/msg/Grip", done={"ok": True})
    settings = replace(device.driver.settings, verbs={**device.driver.settings.verbs, "go": go, "grip": grip})
    told = [sentence for _, sentence in settings.problems(device)]
    assert settings.evidence_of(device) is Evidence.JOINTS
    for said in (
        "rover has evidence: ids, and this mapping proves facts",
        "whoever starts later would do go again; write durability: volatile",
        "what is published has no result, so done, failure and answer say nothing",
        "go is published, so nothing answers the query look by its name; make it a service",
    ):
        assert said in told
    assert any(each.startswith("grip is published, so only facts of topics prove it") for each in told)


def test_fields_of_any_depth_are_filled() -> None:
    call = Call(publish="path", type="nav_msgs/msg/Path")
    now = SimpleNamespace(sec=5)
    fields = {"header.stamp": "$now", "header.frame_id": "map", "poses[1].pose.position.x": 2}
    message = message_of(call, fields, now)
    assert message.header.stamp is now and message.header.frame_id == "map"
    assert [each.pose.position.x for each in message.poses] == [0.0, 2.0]


def test_lists_have_their_length_and_whole_numbers_their_limits() -> None:
    joints = Call(publish="joints", type="sensor_msgs/msg/JointState")
    assert list(message_of(joints, {"position": [1, 2.5], "name": ["a", "b"]}).position) == [1.0, 2.5]
    for type, fields, told in (
        ("geometry_msgs/msg/PoseWithCovariance", {"covariance": [1.0]}, "covariance is a list of 36"),
        ("std_msgs/msg/UInt8", {"data": 300}, "data is 300, and its type is uint8"),
        ("std_msgs/msg/UInt8", {"data": 1.5}, "data is 1.5, and its type is uint8"),
        ("std_msgs/msg/String", {"data[0]": "a"}, "a number in brackets is for lists"),
        ("sensor_msgs/msg/JointState", {"position[0]": 1.0}, "give the list as a whole"),
    ):
        with pytest.raises(DriverError) as raised:
            message_of(Call(publish="x", type=type), fields)  # type: ignore[arg-type]
        assert told in str(raised.value)


def test_a_path_leads_into_lists_and_ends_where_they_do() -> None:
    message = SimpleNamespace(rows=[SimpleNamespace(x=1.5)])
    assert field_at("rows[0].x", message) == 1.5
    assert field_at("rows[1].x", message) is None
    for wrong in ("a b", ".a", "[0]", "a.", ""):
        with pytest.raises(DriverError):
            steps(wrong, FIELD)


def test_the_example_is_good() -> None:
    turtle = load(ROOT / "examples/turtle/pond.yaml").robots["turtle"]
    assert turtle.driver is not None and turtle.driver.name == "ros" and turtle.evidence is Evidence.IDS


def test_what_passes_is_shown_with_examples() -> None:
    lines = [*drivers.messages_of(load(ROOT / "examples/turtle/pond.yaml"))]
    assert lines[0] == "turtle: evidence ids: it says which command it has done"
    assert "  turn 1.5: action /turtle1/rotate_absolute {theta: 1.5}" in lines
    assert lines[-1] == "  heading: /turtle1/pose theta"
