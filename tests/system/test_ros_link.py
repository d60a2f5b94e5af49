"""The ROS 2 ports over real rclpy and Fast DDS, each test in its own domain."""

from __future__ import annotations

import json
import math
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from types import SimpleNamespace

import pytest

pytest.importorskip("rclpy", reason="rclpy is not installed")

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float32MultiArray, String, UInt8, UInt32
from std_srvs.srv import Trigger

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Home, Stop, StopMode
from arboleda.model.errors import StartError
from arboleda.model.messages import (
    Heartbeat,
    Interference,
    Journal,
    MotionState,
    OperatorAnswer,
    Report,
    SystemStart,
    TaskChanged,
    TaskRequest,
    TaskState,
    Uncontested,
    Verb,
)
from arboleda.model.plant_model import Evidence, Link, PlantModel
from arboleda.runtime import host_claim
from arboleda.runtime.host_claim import node_claim
from arboleda.runtime.parts.orchestrator import Orchestrator
from arboleda.store.sqlite import Store
from arboleda.testing import shipped
from arboleda.wire.status import STALE, to_status
from arboleda_ros import convert, statuses
from arboleda_ros.command_topics import NoBridge
from arboleda_ros.link import connect

from ..patience import PATIENCE_S

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
    for publisher in orchestrator.port.commands.plain.values():
        eventually(publisher.get_subscription_count)
    eventually(orchestrator.port._heartbeat.get_subscription_count)
    for voice in bridge.port._voices.values():
        eventually(voice.status.get_subscription_count)
    return SimpleNamespace(bridge=bridge, orchestrator=orchestrator)


def test_every_kind_of_command_and_of_report_crosses_whole(pair):
    commands = [
        MOVE,
        DRIVE,
        SetEffector(id="7-3", robot="ra1", on=True),
        HALT,
        Home(id="7-6", robot="rm_sis_a"),
        Heartbeat(epoch=1_700_000_000),
    ]
    for number, sent in enumerate(commands, 1):
        pair.orchestrator.port.send(sent)
        eventually(lambda number=number: len(pair.bridge.events) == number)
    assert [event.message for event in pair.bridge.events] == commands
    assert {(event.copied, event.sender) for event in pair.bridge.events} == {(False, "")}
    reports = [
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
    ]
    for number, report in enumerate(reports, 1):
        pair.bridge.port.send(report)
        eventually(lambda number=number: len(pair.orchestrator.events) == number)
    assert [replace(event, at=0.0) for event in pair.orchestrator.events] == reports


def test_what_a_stranger_tells_the_bridge_has_no_id_and_what_means_nothing_is_told(links, caplog):
    side, stranger = Side(links(), "bridge", PLANT), Stranger(links(), "stranger")
    rejected = stranger.hear(String, "/ra1/rejected")
    eventually(lambda: side.node.count_subscribers("ra1/rejected"))
    stranger.say("/ra1/command", Float32MultiArray(data=[1.0]))
    told = json.loads(eventually(lambda: rejected)[0].data)
    assert (told["command"], told["reason"], told["count"]) == ("command", "formato", 1)
    stranger.say("/ra1/joint_goals_q", Float32MultiArray(data=[1.0, math.nan, 0.05]))
    forged = convert.command_message(replace(MOVE, id="7-9999"))
    assert [dim.label for dim in forged.layout.dim] == ["id=7-9999"]
    eventually(lambda: "stranger" in publishers(side.node, "/ra1/joint_goals_q"))  # found first, named later
    stranger.say("/ra1/joint_goals_q", forged)
    (event,) = eventually(lambda: side.events)
    assert (event.message, event.sender) == (replace(MOVE, id="", heard=None), "/stranger")
    assert [record.message for record in caplog.records if "/ra1/joint_goals_q" in record.message] != []
    stranger.say("/plant/heartbeat", UInt32(data=2**32 - 1))
    eventually(lambda: "a heartbeat of plant 4294967295 is refused" in caplog.text)
    assert side.port.health().refused == 3
    epoch = int(time.time())
    stranger.say("/plant/heartbeat", UInt32(data=epoch))
    eventually(lambda: len(side.events) == 2)
    assert side.events[1].message == Heartbeat(epoch=epoch)


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


def test_nothing_of_a_stranger_who_publishes_what_a_robot_reports_is_believed(pair, links):
    plant = pair.orchestrator
    pair.bridge.port.send(MOVING)
    eventually(lambda: any(each.state is MotionState.MOVING for each in reported(plant)))
    stranger = Stranger(links(), "forger")
    stranger.say("/ra1/status", status_of(DONE))
    sentence = contest(pair)
    assert sentence == (
        "ra1: more than one node publishes on /ra1/status (/forger and /mqtt_bridge); nothing that it "
        "reports is believed until one is left"
    )
    for _ in range(20):
        stranger.say("/ra1/status", status_of(DONE))
        pair.bridge.port.send(MOVING)
    last = reported(plant)[-1]
    assert (last.state, str(last.lost)) == (MotionState.NO_LINK, sentence)
    stranger.node.destroy_node()

    def is_back() -> bool:
        pair.bridge.port.send(MOVING)
        return reported(plant)[-1].state is MotionState.MOVING

    eventually(is_back)
    assert [each.done for each in reported(plant)] == [None] * len(reported(plant))

    told = len(plant.events)
    link = links()
    node = link.node("guest")
    link.start()
    publisher = node.create_publisher(DiagnosticStatus, "/ra1/status", 10)
    eventually(publisher.get_subscription_count)
    publisher.publish(status_of(DONE))
    node.destroy_publisher(publisher)
    del plant.events[:told]  # what is told from now on
    assert "more than one node publishes on /ra1/status" in contest(pair)
    assert [each.done for each in reported(plant)] == [None] * len(reported(plant))


def test_a_robot_that_says_nothing_counts_again_once_a_stranger_who_spoke_for_it_is_gone(links):
    plant = Side(links(), "orchestrator", shipped("sis_a", link=Link.ROS, evidence=Evidence.STATE))
    robot = Stranger(links(), "robot")
    robot.offer(UInt8, "/rm_sis_a/motion_state")
    stranger = Stranger(links())
    stranger.say("/rm_sis_a/motion_state", UInt8(data=0))
    eventually(lambda: any(isinstance(event, Interference) for event in plant.events))
    assert not [event for event in plant.events if isinstance(event, Uncontested)]
    stranger.node.destroy_node()
    eventually(lambda: isinstance(plant.events[-1], Uncontested))
    last = [event for event in plant.events if isinstance(event, Report)][-1]
    assert last.state is MotionState.NO_LINK  # neither spoke since


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
    commands = pair.orchestrator.port.commands.plain
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


@pytest.mark.parametrize("fallback", [False, True], ids=["EventsExecutor", "SingleThreadedExecutor"])
def test_either_executor_delivers_what_repeats_and_leaves_no_thread(links, monkeypatch, fallback):
    if fallback:
        monkeypatch.setitem(sys.modules, "rclpy.experimental", None)
    before = set(threading.enumerate())
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
    for side in (plant, bridge, plant):  # a second close does nothing
        side.link.close()
    assert set(threading.enumerate()) == before


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


def until_heard(side: Side, state: MotionState, publish: Callable[[], None]) -> None:
    """Publish again and again: what is best effort gets lost before both ends know one another."""

    def heard() -> bool:
        publish()
        time.sleep(0.02)
        return any(event.state is state for event in side.events)

    eventually(heard)


def test_a_robot_on_ros_is_heard_on_its_own_topics_reliable_or_best_effort(links):
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
    publisher = tool.node.create_publisher(UInt8, "/ra1/motion_state", BEST_EFFORT)
    until_heard(side, MotionState.FAULT, lambda: publisher.publish(UInt8(data=2)))
    assert side.port.health().warnings == ()


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


def test_no_task_of_a_burst_is_lost_while_the_plant_is_busy(links):
    free, asked = threading.Event(), []

    def on_event(event: TaskRequest) -> None:
        free.wait(PATIENCE_S)
        asked.append((event.text, event.trigger))

    plant = links()
    plant.orchestrator(PLANT, on_event, time.monotonic)
    plant.start()
    texts = [f"sis_a 0B 7 #{number}" for number in range(MANY)]
    user = Stranger(links())
    for text in texts:
        user.say("task_request", String(data=text), DEEP)
    free.set()
    eventually(lambda: len(asked) == MANY)
    assert asked == [(text, False) for text in texts]
    for value in (0, 5, 1):
        user.say("/ra1/start", UInt8(data=value))
    eventually(lambda: len(asked) > MANY)
    assert asked[MANY:] == [("ra1 palletizing", True)]


class Operator(Stranger):
    """Calls services; each call is a future of the answer."""

    def call(self, service: str) -> object:
        client = self.node.create_client(Trigger, service)
        assert client.wait_for_service(PATIENCE_S), f"no service {service}"
        return client.call_async(Trigger.Request())


def test_every_verb_is_a_service_for_the_whole_plant(links):
    side, operator = Side(links(), "orchestrator", PLANT), Operator(links(), "operator")
    for verb in Verb:
        call = operator.call(f"/plant/{verb.value}")
        asked = eventually(lambda: side.events.pop() if side.events else None)
        assert (asked.verb, asked.scope, asked.by_hand) == (verb, "", False)
        refusal = "ra1 still moves" if verb is Verb.CLEAR else None
        side.port.send(OperatorAnswer(verb=verb, scope="", request=asked.request, refusal=refusal))
        eventually(call.done)
        assert (call.result().success, call.result().message) == (refusal is None, refusal or "")


def test_no_line_of_a_burst_of_changes_is_lost_and_a_late_listener_sees_the_last_ones_and_the_view(links):
    plant, user = Side(links(), "orchestrator", PLANT), Stranger(links())
    heard = user.hear(String, "task_status", DEEP)
    ids = [f"t-7-{number}" for number in range(MANY)]
    for id in ids:
        plant.port.send(TaskChanged(task=id, text="sis_a 0B 7", cell="sis_a", state=TaskState.QUEUED))
        if id == ids[0]:
            eventually(lambda: heard)
    eventually(lambda: len(heard) == MANY)
    assert [json.loads(line.data)["id"] for line in heard] == ids
    for n in (1, 2):
        assert list(plant.port.publish_view({"n": n})) == []
    late = Stranger(links(), "late")
    lines = late.hear(String, "/task_status", LATE)
    views = late.hear(String, "/plant/view", LATE)
    eventually(lambda: lines and json.loads(lines[-1].data)["id"] == ids[-1] and views)
    assert set(json.loads(lines[0].data)) == {"id", "text", "cell", "state", "reason", "sentence"}
    assert [json.loads(view.data) for view in views] == [{"n": 2}]


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
        for publisher in port.commands.labelled.values():
            eventually(publisher.get_subscription_count)
        hang = lambda *_: (reached.set(), let_go.wait(PATIENCE_S))  # noqa: E731
        monkeypatch.setattr(store.tasks, "keep", hang)
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


def test_notices_and_diagnostics_reach_other_nodes_and_a_command_that_no_bridge_hears_is_not_sent(links):
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
    with pytest.raises(NoBridge, match="/ra1/command"):
        side.port.send(MOVE)

    bridge = Side(links(), "bridge", PLANT)
    eventually(bridge.port._diagnostics.get_subscription_count)

    def told_of_broker() -> list:
        rows = [status for message in diagnostics for status in message.status]
        return [(row.level, row.message) for row in rows if row.name == "arboleda: mqtt_bridge on MQTT"]

    down, up = (
        (b"\x02", "not connected to the MQTT broker at x:1"),
        (b"\x00", "connected to the MQTT broker at x:1"),
    )
    bridge.port.mqtt_link(False, "x:1")
    eventually(lambda: told_of_broker() and told_of_broker()[0] == down)
    bridge.port.mqtt_link(True, "x:1")
    eventually(lambda: told_of_broker()[-2:] == [up, up])


def test_a_second_commander_at_start_is_refused_by_name(links, ros_domain):
    other = Stranger(links(), "other_plant")
    other.node.create_publisher(Float32MultiArray, "/ra1/joint_goals_q", 10)
    side = Side(links(), "orchestrator", PLANT)
    with pytest.raises(
        StartError, match="another node already commands /ra1/joint_goals_q: /other_plant; stop"
    ):
        side.port.check_alone(PATIENCE_S)
    assert side.port.topics.alone.others() == [("/ra1/joint_goals_q", "/other_plant")]
    if not host_claim.HAS_ABSTRACT:  # only Linux has names without files
        return
    second = Side(links(), "orchestrator", PLANT)
    sentence = f"commands robots as /orchestrator in ROS domain {ros_domain} of this computer"
    with pytest.raises(StartError, match=sentence):
        second.port.check_alone(0.0)
    side.port.destroy()
    node_claim(ros_domain, "/orchestrator").take()


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
