"""The ROS 2 ports over real rclpy and Fast DDS, each test in its own domain."""

from __future__ import annotations

import functools
import json
import logging
import math
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

pytest.importorskip("rclpy", reason="rclpy is not installed")

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float32MultiArray, MultiArrayDimension, String, UInt8, UInt32
from std_srvs.srv import Trigger

from arboleda.core.leaving import STILL_WAITS, stop_left
from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Home, Stop, StopMode
from arboleda.model.errors import StartError
from arboleda.model.messages import (
    Heartbeat,
    Interference,
    Journal,
    OperatorAnswer,
    OperatorRequest,
    Outcome,
    Report,
    SystemStart,
    TaskChanged,
    TaskRequest,
    TaskState,
    Verb,
)
from arboleda.model.plant_model import Evidence, Link, MotionState, PlantModel
from arboleda.runtime import host_claim
from arboleda.runtime.host_claim import node_claim
from arboleda.runtime.parts.orchestrator import Orchestrator
from arboleda.store.sqlite import Store
from arboleda.testing import shipped
from arboleda.wire.status import STALE, to_status
from arboleda_ros import convert, statuses
from arboleda_ros.link import connect, limit_discovery
from arboleda_ros.orchestrator import NoBridge

from ..patience import PATIENCE_S, SOON_S

pytestmark = pytest.mark.system

BEST_EFFORT = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
LATE = QoSProfile(
    depth=100, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL
)
MANY = 300
DEEP = QoSProfile(depth=MANY, durability=DurabilityPolicy.TRANSIENT_LOCAL)
PLANT = shipped("sis_a")
MOVE = MoveJoints(id="7-1", robot="ra1", q=(0.5, -0.25, 0.0625))
DRIVE = FollowPath(id="7-2", robot="rm_sis_a", nodes=(0, 3, 4))
HALT = Stop(id="7-5", robot="ra1", mode=StopMode.HALT)


def eventually(holds: Callable[[], object], timeout_s: float = PATIENCE_S) -> object:
    """The first true value of `holds`; the test fails where none comes in time."""
    until = time.monotonic() + timeout_s
    while not (value := holds()):
        assert time.monotonic() < until, "nothing came in time"
        time.sleep(0.002)
    return value


@pytest.fixture
def links(monkeypatch: pytest.MonkeyPatch, ros_domain: object) -> Iterator[Callable[[], object]]:
    """Makes links and closes them all at the end of the test."""
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    made = []

    def make() -> object:
        made.append(connect())
        return made[-1]

    yield make
    for link in made:
        link.close()


class Side:
    """A port on its own link, with everything it heard in `events`."""

    def __init__(self, link, part: str, model: PlantModel) -> None:
        self.link = link
        self.events: list = []
        self.port = getattr(link, part)(model, self.events.append, time.monotonic)
        link.start()

    @property
    def node(self):
        return next(iter(self.link._nodes.values()))


class Stranger:
    """Somebody else's node: publishes anything, remembers what it hears."""

    def __init__(self, link, name: str = "stranger") -> None:
        self.node = link.node(name)
        self._publishers: dict = {}
        link.start()

    def say(self, topic: str, message: object, qos: object = 10) -> None:
        self.offer(type(message), topic, qos).publish(message)

    def offer(self, kind: type, topic: str, qos: object = 10) -> Publisher:
        """The publisher of a topic, once somebody listens to it."""
        key = (topic, str(qos))
        if key not in self._publishers:
            self._publishers[key] = self.node.create_publisher(kind, topic, qos)
            eventually(self._publishers[key].get_subscription_count)
        return self._publishers[key]

    def hear(self, kind: type, topic: str, qos: object = 10) -> list:
        heard: list = []
        self.node.create_subscription(kind, topic, heard.append, qos)
        return heard


def publishers(node: Node, topic: str) -> list[str]:
    return [info.node_name for info in node.get_publishers_info_by_topic(topic)]


@pytest.fixture
def pair(links) -> SimpleNamespace:
    """The two parts as two processes would have them: a link each, matched both ways."""
    bridge, orchestrator = Side(links(), "bridge", PLANT), Side(links(), "orchestrator", PLANT)
    eventually(lambda: orchestrator.node.count_subscribers("ra1/joint_goals_q"))
    for publisher in orchestrator.port._commands.values():
        eventually(publisher.get_subscription_count)
    eventually(orchestrator.port._heartbeat.get_subscription_count)
    for voice in bridge.port._voices.values():
        eventually(voice.status.get_subscription_count)
    return SimpleNamespace(bridge=bridge, orchestrator=orchestrator)


@pytest.mark.parametrize(
    "sent",
    [
        MOVE,
        DRIVE,
        SetEffector(id="7-3", robot="ra1", on=True),
        HALT,
        Home(id="7-6", robot="rm_sis_a"),
        Heartbeat(epoch=1_700_000_000),
    ],
    ids=lambda value: type(value).__name__,
)
def test_a_command_reaches_the_bridge_with_its_id(pair, sent):
    began = time.monotonic()
    pair.orchestrator.port.send(sent)
    eventually(lambda: pair.bridge.events)
    (event,) = pair.bridge.events
    assert (event.message, event.copied, event.sender) == (sent, False, "")
    assert began <= event.at <= time.monotonic()


def test_an_id_on_a_plain_topic_makes_no_command_of_the_plant(pair, links):
    stranger = Stranger(links(), "stranger")
    forged = convert.command_message(replace(MOVE, id="7-9999"))
    assert [dim.label for dim in forged.layout.dim] == ["id=7-9999"]
    stranger.say("/ra1/joint_goals_q", forged)
    eventually(lambda: pair.bridge.events)
    (event,) = pair.bridge.events
    assert event.message == replace(MOVE, id="", heard=None)
    assert event.sender


DONE = Report(at=0.0, robot="ra1", state=MotionState.STOPPED, plant=7, epoch=1000, accepted="7-1", done="7-1")
MOVING = replace(DONE, state=MotionState.MOVING, done=None)


def reported(side: Side) -> list[Report]:
    return [event for event in side.events if isinstance(event, Report) and event.robot == "ra1"]


def status_of(report: Report) -> DiagnosticStatus:
    plain = to_status(PLANT.robots["ra1"], report)
    return statuses.diagnostic(plain.name, plain.hardware_id, plain.level, plain.message, plain.values)


def contest(pair) -> str:
    """What is told of a stranger who publishes what a robot reports, while its bridge goes on."""

    def told() -> list[Interference]:
        pair.bridge.port.send(MOVING)
        return [event for event in pair.orchestrator.events if isinstance(event, Interference)]

    return str(eventually(told)[0].sentence)


def test_while_a_stranger_publishes_what_a_robot_reports_nothing_of_that_is_believed(pair, links):
    plant = pair.orchestrator
    pair.bridge.port.send(MOVING)
    eventually(lambda: any(each.state is MotionState.MOVING for each in reported(plant)))
    stranger = Stranger(links(), "forger")
    stranger.say("/ra1/status", status_of(DONE))
    assert contest(pair) == (
        "ra1: more than one node publishes on /ra1/status (/forger and /mqtt_bridge); nothing that it "
        "reports is believed until one is left"
    )
    for _ in range(20):
        stranger.say("/ra1/status", status_of(DONE))
        pair.bridge.port.send(MOVING)
    time.sleep(0.3)
    last = reported(plant)[-1]
    assert (last.state, str(last.lost)) == (MotionState.NO_LINK, contest(pair))
    assert [each.done for each in reported(plant)] == [None] * len(reported(plant))
    stranger.node.destroy_node()

    def is_back() -> bool:
        pair.bridge.port.send(MOVING)
        return reported(plant)[-1].state is MotionState.MOVING

    eventually(is_back)
    assert [each.done for each in reported(plant)] == [None] * len(reported(plant))


def test_what_a_stranger_has_left_who_is_gone_is_not_believed_either(pair, links):
    plant = pair.orchestrator
    pair.bridge.port.send(MOVING)
    eventually(lambda: reported(plant))
    link = links()
    node = link.node("forger")
    link.start()
    publisher = node.create_publisher(DiagnosticStatus, "/ra1/status", 10)
    eventually(publisher.get_subscription_count)
    publisher.publish(status_of(DONE))
    node.destroy_publisher(publisher)
    assert "more than one node publishes on /ra1/status" in contest(pair)
    assert [each.done for each in reported(plant)] == [None] * len(reported(plant))


def test_a_bridge_that_was_started_again_is_believed_beside_the_end_of_the_last_one(pair, links):
    plant = pair.orchestrator
    again = Side(links(), "bridge", PLANT)
    eventually(again.port._voices["ra1"].status.get_subscription_count)

    def is_heard() -> bool:
        again.port.send(DONE)
        return any(each.done == "7-1" for each in reported(plant))

    eventually(is_heard)
    assert not [event for event in plant.events if isinstance(event, Interference)]


def test_who_listens_beside_the_bridge_hears_copies(pair, links):
    person = Stranger(links(), "person")
    goals = person.hear(Float32MultiArray, "/ra1/joint_goals_q")
    grips = person.hear(UInt8, "/ra1/effector_cmd")
    commands = pair.orchestrator.port._commands
    eventually(lambda: commands["ra1", MoveJoints].get_subscription_count() == 2)
    eventually(lambda: commands["ra1", SetEffector].get_subscription_count() == 2)
    grip = SetEffector(id="7-3", robot="ra1", on=True)
    pair.orchestrator.port.send(MOVE)
    pair.orchestrator.port.send(grip)
    eventually(lambda: goals and grips and len(pair.bridge.events) == 3)
    assert [dim.label for dim in goals[0].layout.dim] == ["id=7-1", "copy"]
    assert grips[0].data == 1
    heard = [(event.message, event.copied) for event in pair.bridge.events]
    assert sorted(heard, key=str) == sorted(
        [(MOVE, False), (grip, True), (replace(grip, id=""), False)], key=str
    )


@pytest.mark.parametrize(
    ("labels", "data"),
    [
        ([], [1.0]),
        (["id=7-1"], [1.0]),
        (["id=7-1", "path_cmd"], [1.0]),
        (["7-1", "effector_cmd"], [1.0]),
        (["id=7-1", "effector_cmd"], [1.5]),
        (["id=7-1", "effector_cmd"], [7.0]),
        (["id=7-1", "effector_cmd"], [math.nan]),
        (["id=7-1", "effector_cmd"], []),
    ],
    ids=lambda value: " ".join(map(str, value)) or "none",
)
def test_a_broken_command_with_an_id_is_refused_and_told(links, labels, data):
    side, tool = Side(links(), "bridge", PLANT), Stranger(links())
    rejected = tool.hear(String, "/ra1/rejected")
    eventually(lambda: side.node.count_subscribers("ra1/rejected"))
    broken = Float32MultiArray(data=data)
    broken.layout.dim = [MultiArrayDimension(label=label, size=len(data), stride=1) for label in labels]
    tool.say("/ra1/command", broken)
    (told,) = eventually(lambda: rejected)
    assert json.loads(told.data)["reason"] == "formato"
    assert json.loads(told.data)["count"] == 1
    assert side.events == []


@pytest.mark.parametrize(
    "report",
    [
        Report(at=0.0, robot="ra1", state=MotionState.NO_LINK, epoch=9),
        Report(
            at=0.0,
            robot="ra1",
            epoch=9,
            boot_id=4,
            accepted="7-2",
            done="7-1",
            rejected="7-0",
            refusal="limite",
            state=MotionState.STOPPED,
            q=(0.1, -0.2, 0.03),
            homed=True,
            effector=False,
            piece=True,
        ),
        Report(at=0.0, robot="rm_sis_a", epoch=9, state=MotionState.MOVING, node=4, homed=False),
    ],
    ids=["no link", "arm", "mobile"],
)
def test_a_report_comes_back_equal(pair, report):
    pair.bridge.port.send(report)
    event = eventually(lambda: pair.orchestrator.events and pair.orchestrator.events[0])
    assert replace(event, at=0.0) == report


@pytest.mark.parametrize("fallback", [False, True], ids=["EventsExecutor", "SingleThreadedExecutor"])
def test_a_report_that_repeats_the_last_comes_at_its_own_time(links, monkeypatch, fallback):
    if fallback:
        monkeypatch.setitem(__import__("sys").modules, "rclpy.experimental", None)
    plant, bridge = Side(links(), "orchestrator", PLANT), Side(links(), "bridge", PLANT)
    eventually(bridge.port._voices["ra1"].status.get_subscription_count)
    report = Report(at=0.0, robot="ra1", epoch=9, state=MotionState.STOPPED, q=(0.1, -0.2, 0.03))
    said = []
    for count in (1, 2, 3):
        said.append(time.monotonic())
        bridge.port.send(report)
        eventually(lambda: len(plant.events) == count)  # noqa: B023 - it is called at once
    assert all(replace(event, at=0.0) == report for event in plant.events)
    assert all(event.at >= at for event, at in zip(plant.events, said, strict=True))


def test_the_bridge_publishes_what_existing_tools_read(links):
    side, tool = Side(links(), "bridge", PLANT), Stranger(links())
    states, pieces = tool.hear(UInt8, "/ra1/motion_state"), tool.hear(Bool, "/ra1/piece_detected")
    joints = tool.hear(JointState, "/r1/joint_states")
    places = tool.hear(JointState, "/rm_sis_a/joint_states")
    for voice in side.port._voices.values():
        eventually(voice.joints.get_subscription_count)
    eventually(lambda: side.port._voices["ra1"].state.get_subscription_count())
    eventually(lambda: side.port._voices["ra1"].piece.get_subscription_count())
    side.port.send(Report(at=0.0, robot="ra1", state=MotionState.NO_LINK, q=(9.0, 9.0, 9.0)))
    side.port.send(Report(at=0.0, robot="ra1", state=MotionState.STOPPED, q=(0.1, 0.2, 0.03), piece=False))
    side.port.send(Report(at=0.0, robot="rm_sis_a", state=MotionState.STOPPED, node=5))
    eventually(lambda: len(states) == 2 and pieces and joints and places)
    assert [message.data for message in states] == [255, 0]
    assert [message.data for message in pieces] == [False]
    assert joints[0].name == ["r1_brazo_joint", "r1_antebrazo_joint", "r1_efector_joint"]
    assert list(joints[0].position) == [0.1, 0.2, 0.03], "nothing is published while there is no link"
    assert joints[0].header.stamp.sec > 0
    assert places[0].name == ["rm_sis_a_x_joint", "rm_sis_a_y_joint"]
    assert list(places[0].position) == pytest.approx([0.2, 0.1])


@pytest.mark.parametrize(
    ("topic", "bad", "good"),
    [
        ("/ra1/joint_goals_q", Float32MultiArray(data=[1.0, 2.0]), Float32MultiArray(data=[1.0, 2.0, 0.05])),
        (
            "/ra1/joint_goals_q",
            Float32MultiArray(data=[1.0, math.nan, 0.05]),
            Float32MultiArray(data=[0.0] * 3),
        ),
        ("/rm_sis_a/path_cmd", Float32MultiArray(data=[0.0, 3.5]), Float32MultiArray(data=[0.0, 3.0])),
        ("/rm_sis_a/path_cmd", Float32MultiArray(data=[0.0, 9.0]), Float32MultiArray(data=[0.0, 1.0])),
        ("/rm_sis_a/path_cmd", Float32MultiArray(), Float32MultiArray(data=[0.0])),
        ("/ra1/effector_cmd", UInt8(data=7), UInt8(data=0)),
        ("/rm_sis_a/stop_cmd", UInt8(data=9), UInt8(data=1)),
        ("/ra1/home_cmd", UInt8(data=0), UInt8(data=1)),
    ],
    ids=["2 of 3 joints", "NaN", "half a node", "node 9", "no node", "effector 7", "stop 9", "home 0"],
)
def test_a_bad_command_is_refused_whole_and_the_next_one_works(links, caplog, topic, bad, good):
    side, tool = Side(links(), "bridge", PLANT), Stranger(links())
    tool.say(topic, bad)
    tool.say(topic, good)
    eventually(lambda: side.events)
    assert len(side.events) == 1 and side.events[0].message.id == ""
    assert side.port.health().refused == 1
    assert [record.message for record in caplog.records if topic in record.message] != []


@pytest.mark.parametrize(("label", "size"), [("id=", 3), ("id=7 1", 3), ("id=7-1", 2)])
def test_a_broken_label_is_refused(links, label, size):
    side, tool = Side(links(), "bridge", PLANT), Stranger(links())
    broken = Float32MultiArray(data=[0.0, 0.0, 0.0])
    broken.layout.dim = [MultiArrayDimension(label=label, size=size, stride=size)]
    tool.say("/ra1/joint_goals_q", broken)
    eventually(lambda: side.port.health().refused)
    assert side.events == []


def test_a_robot_on_ros_is_heard_on_its_own_topics(links):
    side = Side(links(), "orchestrator", shipped("sis_a", link=Link.ROS, evidence=Evidence.JOINTS))
    tool = Stranger(links(), "robot")
    shuffled = ["r1_efector_joint", "other_joint", "r1_brazo_joint", "r1_antebrazo_joint"]
    names = ["rm_sis_a_x_joint", "rm_sis_a_y_joint"]
    said = [
        ("/ra1/motion_state", UInt8(data=1)),
        ("/ra1/piece_detected", Bool(data=True), BEST_EFFORT),
        ("/r1/joint_states", JointState(name=shuffled, position=[0.03, 8.0, 0.1, 0.2])),
        ("/rm_sis_a/joint_states", JointState(name=names, position=[0.195, 0.105])),
        ("/rm_sis_a/joint_states", JointState(name=names, position=[0.15, 0.10])),
    ]
    for number, message in enumerate(said, 1):  # a topic keeps only its last message for who is late
        tool.say(*message)
        eventually(lambda number=number: len(side.events) == number)
    facts = [
        (event.robot, event.state, event.q, event.node, event.piece)
        for event in sorted(side.events, key=lambda event: event.at)
    ]
    assert set(facts) == {
        ("ra1", MotionState.MOVING, None, None, None),
        ("ra1", None, None, None, True),
        ("ra1", None, (0.1, 0.2, 0.03), None, None),
        ("rm_sis_a", None, None, 5, None),
        ("rm_sis_a", None, None, None, None),
    }


def test_commands_of_others_to_a_robot_on_ros_are_told_with_their_sender(links):
    side = Side(links(), "orchestrator", shipped("sis_a", link=Link.ROS, evidence=Evidence.STATE))
    own = [MOVE, MOVE, SetEffector(id="7-3", robot="ra1", on=True), HALT, DRIVE]
    for command in own:
        side.port.send(command)
    stranger = Stranger(links(), "teach")
    for kind, topic in ((Float32MultiArray, "/ra1/joint_goals_q"), (UInt8, "/ra1/effector_cmd")):
        stranger.offer(kind, topic)
        eventually(lambda topic=topic: "teach" in publishers(side.node, topic))  # found first, named later
    stranger.say("/ra1/joint_goals_q", Float32MultiArray(data=list(MOVE.q)))
    stranger.say("/ra1/effector_cmd", UInt8(data=1))
    eventually(lambda: len(side.events) == 2)
    assert all(isinstance(event, Interference) and event.robot == "ra1" for event in side.events)
    assert [str(event.sentence) for event in side.events] == [
        "ra1: joint_goals_q of /teach was sent to it",
        "ra1: effector_cmd 1 of /teach was sent to it",
    ]


def test_a_person_answers_by_hand_at_evidence_state(links):
    side = Side(links(), "orchestrator", shipped("sis_a", link=Link.ROS, evidence=Evidence.STATE))
    person = Stranger(links(), "person")
    goals = person.hear(Float32MultiArray, "/ra1/joint_goals_q")
    eventually(lambda: side.port._commands["ra1", MoveJoints].get_subscription_count() == 2)
    side.port.send(MOVE)
    eventually(lambda: goals)
    for code in (1, 7, 0):
        person.say("/ra1/motion_state", UInt8(data=code))
    eventually(lambda: len(side.events) == 2)
    assert [event.state for event in side.events] == [MotionState.MOVING, MotionState.STOPPED]
    assert side.port.health().refused == 1
    assert (goals[0].layout.dim[0].label, goals[0].layout.dim[0].size) == ("id=7-1", 3)


@pytest.mark.parametrize("fallback", [False, True], ids=["EventsExecutor", "SingleThreadedExecutor"])
def test_a_robot_that_speaks_best_effort_is_heard(links, monkeypatch, fallback):
    if fallback:
        monkeypatch.setitem(__import__("sys").modules, "rclpy.experimental", None)
    side = Side(links(), "orchestrator", shipped("sis_a", link=Link.ROS, evidence=Evidence.STATE))
    robot = Stranger(links(), "robot")
    publisher = robot.node.create_publisher(UInt8, "/ra1/motion_state", BEST_EFFORT)
    until_heard(side, MotionState.MOVING, lambda: publisher.publish(UInt8(data=1)))
    tell = functools.partial(robot.say, "/ra1/motion_state")
    until_heard(side, MotionState.FAULT, lambda: tell(UInt8(data=2)))  # who is reliable is heard too
    tell(UInt8(data=3))
    eventually(lambda: side.events[-1].state is MotionState.NOT_HOMED)
    publisher.publish(UInt8(data=0))
    eventually(lambda: side.events[-1].state is MotionState.STOPPED)
    assert sum(event.state is MotionState.NOT_HOMED for event in side.events) == 1
    assert side.port.health().warnings == ()


def until_heard(side: Side, state: MotionState, publish: Callable[[], None]) -> None:
    """Publish again and again: what is best effort gets lost before both ends know one another."""

    def heard() -> bool:
        publish()
        time.sleep(0.02)
        return any(event.state is state for event in side.events)

    eventually(heard)


def test_a_status_that_comes_best_effort_is_heard(links):
    side = Side(links(), "orchestrator", shipped("sis_a", link=Link.ROS, evidence=Evidence.IDS))
    robot = Stranger(links(), "robot")
    publisher = robot.node.create_publisher(DiagnosticStatus, "/ra1/status", BEST_EFFORT)
    said = to_status(shipped("sis_a").robots["ra1"], Report(at=0.0, robot="ra1", state=MotionState.MOVING))
    message = statuses.diagnostic(said.name, said.hardware_id, said.level, said.message, said.values)
    until_heard(side, MotionState.MOVING, lambda: publisher.publish(message))
    assert side.port.health().warnings == ()


def test_task_texts_and_triggers_become_requests(links):
    side, user = Side(links(), "orchestrator", PLANT), Stranger(links(), "user")
    user.say("/task_request", String(data="sis_a 0B 7"))
    eventually(lambda: side.events)
    for value in (0, 5, 1):
        user.say("/ra1/start", UInt8(data=value))
    eventually(lambda: len(side.events) == 2)
    assert all(isinstance(event, TaskRequest) and event.request is None for event in side.events)
    asked = [(event.text, event.trigger) for event in side.events]
    assert asked == [("sis_a 0B 7", False), ("ra1 palletizing", True)]


class Operator(Stranger):
    """Calls services; each call is a future of the answer."""

    def call(self, service: str) -> object:
        client = self.node.create_client(Trigger, service)
        assert client.wait_for_service(PATIENCE_S), f"no service {service}"
        return client.call_async(Trigger.Request())


def answered(side: Side, refusal: str | None = None, **told: Any) -> OperatorRequest:
    """What the plant was asked for, once; it was answered as its own thread answers."""
    asked = eventually(lambda: side.events.pop() if side.events else None)
    side.port.send(OperatorAnswer(verb=asked.verb, scope="", request=asked.request, refusal=refusal, **told))
    return asked


def test_no_task_of_a_burst_is_lost_while_the_plant_is_busy(links):
    free, texts = threading.Event(), []

    def on_event(event: TaskRequest) -> None:
        free.wait(PATIENCE_S)
        texts.append(event.text)

    plant = links()
    plant.orchestrator(PLANT, on_event, time.monotonic)
    plant.start()
    asked = [f"sis_a 0B 7 #{number}" for number in range(MANY)]
    user = Stranger(links())
    for text in asked:
        user.say("task_request", String(data=text), DEEP)
    free.set()
    eventually(lambda: len(texts) == MANY)
    assert texts == asked


def test_no_line_of_a_burst_of_changes_is_lost(links):
    plant, user = Side(links(), "orchestrator", PLANT), Stranger(links())
    heard = user.hear(String, "task_status", DEEP)
    ids = [f"t-7-{number}" for number in range(MANY)]
    for id in ids:
        plant.port.send(TaskChanged(task=id, text="sis_a 0B 7", cell="sis_a", state=TaskState.QUEUED))
        if id == ids[0]:
            eventually(lambda: heard)
    eventually(lambda: len(heard) == MANY)
    assert [json.loads(line.data)["id"] for line in heard] == ids


def test_every_verb_is_a_service_for_the_whole_plant(links):
    side, operator = Side(links(), "orchestrator", PLANT), Operator(links(), "operator")
    for verb in Verb:
        began = time.monotonic()
        call = operator.call(f"/plant/{verb.value}")
        asked = answered(side)
        assert (asked.verb, asked.scope, asked.by_hand) == (verb, "", False)
        assert began <= asked.at <= time.monotonic()
        eventually(call.done)
        assert (call.result().success, call.result().message) == (True, "")


def test_a_refused_verb_says_why(links):
    side, operator = Side(links(), "orchestrator", PLANT), Operator(links(), "operator")
    call = operator.call("/plant/clear")
    answered(side, refusal="ra1 still moves")
    eventually(call.done)
    assert (call.result().success, call.result().message) == (False, "ra1 still moves")


def test_a_stop_that_has_left_and_is_not_kept_says_so(links):
    side, operator = Side(links(), "orchestrator", PLANT), Operator(links(), "operator")
    call = operator.call("/plant/stop")
    asked = eventually(lambda: side.events.pop() if side.events else None)
    side.port.send(stop_left(asked, STILL_WAITS()))
    eventually(call.done)
    assert call.result().success
    assert "left for the whole plant, and the plant has not kept it" in call.result().message


def test_a_service_stops_robots_while_the_plant_waits_for_its_disk(links, tmp_path, monkeypatch):
    """Also where the publication of what happened hangs: it is the same thread."""
    reached, let_go, told = threading.Event(), threading.Event(), set()
    bridge, operator = links(), Operator(links(), "operator")
    bridge.bridge(PLANT, lambda event: told.add(type(event.message)), time.monotonic)
    bridge.start()
    with Store(tmp_path / "plant.sqlite") as store:
        plant, link = Orchestrator(PLANT, 7, pytest.fail, store), links()
        port = link.orchestrator(PLANT, plant.hear, time.monotonic)
        plant.connect(port)
        plant.connect_ros(port)
        link.start()
        for publisher in port._labelled.values():
            eventually(publisher.get_subscription_count)
        hang = lambda *_: (reached.set(), let_go.wait(PATIENCE_S))  # noqa: E731
        monkeypatch.setattr(store, "task", hang)
        plant.start()
        try:
            plant.submit("sis_a 0B 1")
            assert reached.wait(PATIENCE_S)
            call = operator.call("/plant/stop")
            eventually(lambda: Stop in told)
            eventually(call.done)
            assert not let_go.is_set()
        finally:
            let_go.set()
            plant.stop()
    assert call.result().success and "has not kept it" in call.result().message


@pytest.mark.parametrize(
    ("told", "said"),
    [
        (
            {"act": 7, "outcome": Outcome.UNDER_WAY},
            (True, "under way: `acts` of /plant/view tell the outcome of act 7"),
        ),
        ({"act": 7, "outcome": Outcome.FAILED, "why": "jaw: it is stuck"}, (False, "jaw: it is stuck")),
        ({"act": 7, "outcome": Outcome.UNCHECKED, "why": "jaw says nothing"}, (True, "jaw says nothing")),
        ({"act": 7, "outcome": Outcome.DONE}, (True, "")),
    ],
)
def test_an_act_of_devices_is_answered_as_it_stands(links, told, said):
    side, operator = Side(links(), "orchestrator", PLANT), Operator(links(), "operator")
    call = operator.call("/plant/release")
    answered(side, **told)
    eventually(call.done)
    assert (call.result().success, call.result().message) == said


def test_answers_to_others_are_passed_over(links):
    side, operator = Side(links(), "orchestrator", PLANT), Operator(links(), "operator")
    call = operator.call("/plant/stop")
    eventually(lambda: side.events)
    for request in (None, "of the web server"):
        side.port.send(OperatorAnswer(verb=Verb.STOP, scope="", request=request, refusal="no"))
    answered(side)
    eventually(call.done)
    assert call.result().success


def test_a_plant_that_does_not_answer_is_said_to_and_keeps_the_topics(links, monkeypatch):
    monkeypatch.setattr("arboleda_ros.plant_queries.ANSWER_S", 0.1)
    side, operator = Side(links(), "orchestrator", PLANT), Operator(links(), "operator")
    call = operator.call("/plant/stop")
    eventually(call.done)
    assert not call.result().success and "did not answer in time" in call.result().message
    late = side.events.pop()
    side.port.send(OperatorAnswer(verb=Verb.STOP, scope="", request=late.request))
    operator.say("/task_request", String(data="sis_a 0B 7"))
    eventually(lambda: side.events)


def test_a_verb_that_fails_inside_is_answered_too(links, caplog):
    side, operator = Side(links(), "orchestrator", PLANT), Operator(links(), "operator")
    side.port._asker._post = lambda request: 1 / 0
    call = operator.call("/plant/hold")
    eventually(call.done)
    assert (call.result().success, call.result().message) == (False, "internal error")
    assert "hold plant failed" in caplog.text


def test_a_late_listener_still_sees_the_task_status_and_the_view(links):
    side = Side(links(), "orchestrator", PLANT)
    for state in (TaskState.QUEUED, TaskState.RUNNING):
        side.port.send(TaskChanged(task="t-1", text="sis_a 0B 7", cell="sis_a", state=state))
    for n in (1, 2):
        assert list(side.port.publish_view({"n": n})) == []
    late = Stranger(links(), "late")
    lines = late.hear(String, "/task_status", LATE)
    views = late.hear(String, "/plant/view", LATE)
    eventually(lambda: len(lines) == 2 and views)
    assert [json.loads(line.data)["state"] for line in lines] == ["queued", "running"]
    assert set(json.loads(lines[0].data)) == {"id", "text", "cell", "state", "reason", "sentence"}
    assert [json.loads(view.data) for view in views] == [{"n": 2}]


def test_notices_reach_other_nodes(links):
    side, tool = Side(links(), "orchestrator", PLANT), Stranger(links(), "tool")
    starts, beats = tool.hear(UInt8, "/system/start"), tool.hear(UInt32, "/plant/heartbeat")
    diagnostics = tool.hear(DiagnosticArray, "/diagnostics")
    for publisher in (side.port._start, side.port._heartbeat, side.port._diagnostics):
        eventually(publisher.get_subscription_count)
    silent = ("arboleda: ra1", "ra_1", STALE, "silent", {"node": "4"})
    side.port.send(Journal(verb=Verb.STOP, scope="", cell=None, sentence="kept in the plant's own process"))
    side.port.send(SystemStart(cell="sis_a"))
    side.port.send(Heartbeat(epoch=7))
    assert len(list(side.port.publish_diagnostics([silent]))) == 1
    eventually(lambda: starts and beats and len(diagnostics) > 1)
    assert (starts[0].data, beats[0].data) == (1, 7)
    told = {message.status[0].name: message.status[0] for message in diagnostics}
    assert told["arboleda: orchestrator on ROS 2"].level == b"\x00"
    status = told["arboleda: ra1"]
    assert (status.hardware_id, status.level) == ("ra_1", b"\x03")
    assert (status.message, status.values[0].key, status.values[0].value) == ("silent", "node", "4")


def test_the_bridge_tells_of_its_broker_at_once_and_again(links):
    side, tool = Side(links(), "bridge", PLANT), Stranger(links(), "tool")
    heard = tool.hear(DiagnosticArray, "/diagnostics")
    eventually(side.port._diagnostics.get_subscription_count)

    def told() -> list:
        rows = [status for message in heard for status in message.status]
        return [(row.level, row.message) for row in rows if row.name == "arboleda: mqtt_bridge on MQTT"]

    down, up = (
        (b"\x02", "not connected to the MQTT broker at x:1"),
        (b"\x00", "connected to the MQTT broker at x:1"),
    )
    side.port.mqtt_link(False, "x:1")
    eventually(lambda: told() and told()[0] == down)
    side.port.mqtt_link(True, "x:1")
    eventually(lambda: told()[-2:] == [up, up])


def test_a_command_that_no_bridge_hears_is_not_sent(links):
    side = Side(links(), "orchestrator", PLANT)
    with pytest.raises(NoBridge, match="/ra1/command"):
        side.port.send(MOVE)


def test_a_second_commander_at_start_is_refused_by_name(links):
    other = Stranger(links(), "other_plant")
    other.node.create_publisher(Float32MultiArray, "/ra1/joint_goals_q", 10)
    side = Side(links(), "orchestrator", PLANT)
    with pytest.raises(
        StartError, match="another node already commands /ra1/joint_goals_q: /other_plant; stop"
    ):
        side.port.check_alone(PATIENCE_S)
    assert side.port._alone.others() == [("/ra1/joint_goals_q", "/other_plant")]


def test_discovery_finds_a_second_orchestrator_of_the_same_name(links):
    Side(links(), "orchestrator", PLANT)  # which has claimed nothing, as on another computer
    second = Side(links(), "orchestrator", PLANT)
    with pytest.raises(StartError, match=r"another node already commands /.*: /orchestrator;"):
        second.port.check_alone(PATIENCE_S)


@pytest.mark.skipif(not host_claim.HAS_ABSTRACT, reason="only Linux has names without files")
def test_a_second_orchestrator_on_this_computer_is_refused_without_discovery(links, ros_domain):
    first = Side(links(), "orchestrator", PLANT)
    first.port.check_alone(0.0)
    second = Side(links(), "orchestrator", PLANT)
    sentence = f"commands robots as /orchestrator in ROS domain {ros_domain} of this computer"
    with pytest.raises(StartError, match=sentence):
        second.port.check_alone(0.0)
    first.port.destroy()
    node_claim(ros_domain, "/orchestrator").take()


def test_a_heartbeat_of_the_far_future_is_refused_and_said(links, caplog):
    side, stranger = Side(links(), "bridge", PLANT), Stranger(links())
    stranger.say("/plant/heartbeat", UInt32(data=2**32 - 1))
    eventually(lambda: "a heartbeat of plant 4294967295 is refused" in caplog.text)
    assert side.port.health().refused == 1
    epoch = int(time.time())
    stranger.say("/plant/heartbeat", UInt32(data=epoch))
    eventually(lambda: Heartbeat(epoch=epoch) in [event.message for event in side.events])
    assert [event.message.epoch for event in side.events] == [epoch]


def test_a_later_commander_is_an_error_in_the_diagnostics(links, caplog):
    side = Side(links(), "orchestrator", PLANT)
    side.port.check_alone(0.1)
    assert side.port.health().errors == ()
    diagnostics = Stranger(links(), "screen").hear(DiagnosticArray, "/diagnostics")
    intruder = Stranger(links(), "intruder").node
    publisher = intruder.create_publisher(UInt8, "/rm_sis_a/stop_cmd", 10)
    sentence = "another node commands /rm_sis_a/stop_cmd: /intruder"
    eventually(lambda: side.port.health().errors == (sentence,))
    eventually(lambda: any(message.status[0].message == sentence for message in diagnostics))
    assert diagnostics[-1].status[0].level == b"\x02"
    assert sum("/intruder" in record.message for record in caplog.records) == 1
    intruder.destroy_publisher(publisher)
    eventually(lambda: side.port.health().errors == ())
    intruder.create_publisher(UInt8, "/rm_sis_a/stop_cmd", 10)
    eventually(lambda: side.port.health().errors == (sentence,))
    assert sum("/intruder" in record.message for record in caplog.records) == 2


def test_an_incompatible_endpoint_is_one_warning_and_the_plant_goes_on(links, caplog):
    side, tool = Side(links(), "bridge", PLANT), Stranger(links(), "tool")
    for _ in range(2):
        tool.node.create_publisher(UInt8, "/ra1/effector_cmd", BEST_EFFORT)
    eventually(lambda: side.port.health().warnings)
    tool.say("/ra1/effector_cmd", UInt8(data=1))
    eventually(lambda: side.events)
    diagnostics = tool.hear(DiagnosticArray, "/diagnostics")
    eventually(lambda: diagnostics)
    (warning,) = side.port.health().warnings
    assert (diagnostics[0].status[0].message, diagnostics[0].status[0].level) == (warning, b"\x01")
    assert "/ra1/effector_cmd" in warning and "RELIABILITY" in warning
    assert [record.message for record in caplog.records if record.name == "arboleda.ros.mqtt_bridge"] == [
        warning
    ]


def test_a_handler_that_raises_does_not_end_the_thread(links, caplog):
    link, events = links(), []

    def fragile(event):
        if event.message == Heartbeat(epoch=13):
            raise RuntimeError("boom")
        events.append(event)

    port = link.bridge(PLANT, fragile, time.monotonic)
    link.start()
    tool = Stranger(links())
    for epoch in (13, 14):
        tool.say("/plant/heartbeat", UInt32(data=epoch))
    eventually(lambda: events)
    assert events[0].message == Heartbeat(epoch=14)
    assert port.health().failures == 1
    assert "/plant/heartbeat" in caplog.text


@pytest.mark.parametrize("fallback", [False, True], ids=["EventsExecutor", "SingleThreadedExecutor"])
def test_close_is_quick_and_leaves_no_thread(links, monkeypatch, fallback):
    if fallback:
        monkeypatch.setitem(__import__("sys").modules, "rclpy.experimental", None)
    before = set(threading.enumerate())
    side = Side(links(), "bridge", PLANT)
    Stranger(side.link).say("/plant/heartbeat", UInt32(data=1))
    eventually(lambda: side.events)
    began = time.monotonic()
    side.link.close()
    side.link.close()
    assert time.monotonic() - began < SOON_S
    assert set(threading.enumerate()) == before


def test_discovery_stays_on_this_machine_unless_the_user_says_otherwise():
    fresh: dict[str, str] = {}
    assert "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST" in limit_discovery(fresh, lan=False)
    assert fresh == {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    humble = {"ROS_DISTRO": "humble"}
    assert limit_discovery(humble, lan=False) and humble["ROS_LOCALHOST_ONLY"] == "1"
    chosen = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}
    assert limit_discovery(chosen, lan=False) is None and len(chosen) == 1
    assert limit_discovery({}, lan=True) is None


def test_the_way_to_the_bridge_and_back_takes_milliseconds(pair, record_property):
    """The way itself: one of many is that quick, however long the others waited for a core."""
    took, answers = [], pair.orchestrator.events
    until = time.monotonic() + PATIENCE_S
    pair.bridge.port._on_event = lambda event: pair.bridge.port.send(
        Report(at=0.0, robot="ra1", accepted=event.message.id, state=MotionState.MOVING, q=(0.1, 0.2, 0.03))
    )
    while len(took) < 100 or min(took) >= 0.05:
        began, n = time.monotonic(), len(took)
        pair.orchestrator.port.send(replace(MOVE, id=f"7-{n + 1}"))
        while len(answers) == n:
            time.sleep(0.0001)
            assert time.monotonic() < until, took
        took.append(time.monotonic() - began)
    logging.getLogger("arboleda.test").info(
        "round trip: median %.2f ms, max %.2f ms", sorted(took)[50] * 1e3, max(took) * 1e3
    )


def test_types_of_others_that_are_not_installed_are_one_line(links, caplog, monkeypatch):
    monkeypatch.setitem(sys.modules, "py_trees_ros_interfaces", None)
    monkeypatch.delitem(sys.modules, "arboleda_ros.snapshot_streams", raising=False)
    with caplog.at_level(logging.INFO, "arboleda.ros"):
        links().orchestrator(PLANT, [].append, time.monotonic)
    said = [record.message for record in caplog.records if "py_trees" in record.message]
    assert said == ["py_trees_ros_interfaces is not installed here: no trees for py-trees-tree-watcher"]
