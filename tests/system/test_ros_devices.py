"""Devices of declared kinds over real rclpy: one topic for all their commands, their facts in `status`."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from dataclasses import replace

import pytest

pytest.importorskip("rclpy", reason="rclpy is not installed")

from std_msgs.msg import String, UInt8

from arboleda.kinds.declared import VerbCall
from arboleda.model.commands import Command, Stop, StopMode
from arboleda.model.messages import Interference, MotionState, Report
from arboleda.model.plant_model import Evidence, Link, PlantModel
from arboleda_ros.link import connect

from ..patience import PATIENCE_S
from ..unit.kinds.station import STATION, plant

pytestmark = pytest.mark.system

WARM = STATION.command(id="7-1", robot="station", verb="warm", values={"celsius": 40.5})
HALT = Stop(id="7-2", robot="station", mode=StopMode.HALT)
REPORT = Report(
    at=0.0,
    robot="station",
    epoch=9,
    done="7-1",
    failed="7-2",
    failure="atasco",
    answered="7-3",
    answer="heavy",
    state=MotionState.STOPPED,
    facts=(("at", "left"), ("lamp", True), ("held", False), ("celsius", 40.0)),
)


def eventually(holds: Callable[[], object]) -> object:
    """The first true value of `holds`; the test fails where none comes in time."""
    until = time.monotonic() + PATIENCE_S
    while not (value := holds()):
        assert time.monotonic() < until, "nothing came in time"
        time.sleep(0.002)
    return value


class Side:
    """A node of its own with a port or without, and everything that the port heard."""

    def __init__(self, part: str, model: PlantModel) -> None:
        self.link = connect()
        self.events: list = []
        self.port = getattr(self.link, part)(model, self.events.append, time.monotonic) if part else None
        self.node = next(iter(self.link._nodes.values())) if part else self.link.node("somebody")
        self.link.start()

    def hear(self, kind: type, topic: str) -> list:
        heard: list = []
        self.node.create_subscription(kind, topic, heard.append, 10)
        return heard

    def say(self, topic: str, message: object, to: Side) -> None:
        """Publish a message once the other side knows by name whose it is."""
        publisher = self.node.create_publisher(type(message), topic, 10)
        eventually(publisher.get_subscription_count)
        eventually(lambda: "somebody" in to.publishers(topic))
        publisher.publish(message)

    def publishers(self, topic: str) -> list[str]:
        return [each.node_name for each in self.node.get_publishers_info_by_topic(topic)]


@pytest.fixture
def side(ros_domain: int, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Side]]:
    """Makes sides and closes them all at the end of the test."""
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    made: list[Side] = []

    def make(part: str = "", model: PlantModel | None = None) -> Side:
        made.append(Side(part, model or plant()))
        return made[-1]

    yield make
    for each in made:
        each.link.close()


def talking(side: Callable[..., Side]) -> tuple[Side, Side]:
    """Plant and bridge, matched both ways."""
    bridge, orchestrator = side("bridge"), side("orchestrator")
    eventually(lambda: orchestrator.node.count_subscribers("station/order"))
    for publisher in orchestrator.port.commands.plain.values():
        eventually(publisher.get_subscription_count)
    eventually(bridge.port._voices["station"].status.get_subscription_count)
    return orchestrator, bridge


def test_orders_and_stops_reach_the_bridge_with_their_ids_and_a_report_comes_back(
    side: Callable[..., Side],
) -> None:
    orchestrator, bridge = talking(side)
    sent: list[Command] = [WARM, HALT]
    for command in sent:
        orchestrator.port.send(command)
    eventually(lambda: len(bridge.events) == 2)
    assert [event.message for event in bridge.events] == sent
    assert {(event.copied, event.sender) for event in bridge.events} == {(False, "")}
    bridge.port.send(REPORT)
    (event,) = eventually(lambda: orchestrator.events)  # type: ignore[misc]
    assert replace(event, at=0.0) == REPORT


def test_what_somebody_else_orders_has_no_id_and_what_means_nothing_is_told(
    side: Callable[..., Side],
) -> None:
    bridge, person = side("bridge"), side()
    rejected = person.hear(String, "station/rejected")
    eventually(lambda: bridge.node.count_subscribers("station/rejected"))
    person.say("station/order", String(data='{"verb": "fly"}'), bridge)
    (told,) = eventually(lambda: rejected)  # type: ignore[misc]
    said = json.loads(told.data)
    assert (said["command"], said["reason"]) == ("order", "formato")
    assert "a station has no verb 'fly'" in said["sentence"]
    person.say("station/order", String(data='{"verb": "warm", "values": {"celsius": 40.5}}'), bridge)
    eventually(lambda: bridge.events)
    person.say("station/stop_cmd", UInt8(data=1), bridge)
    eventually(lambda: len(bridge.events) == 2)
    order, stop = bridge.events
    assert (order.message, order.sender) == (replace(WARM, id=""), "/somebody")
    assert stop.message == Stop(id="", robot="station", mode=StopMode.LATCH)
    topics = {name for name, _ in person.node.get_topic_names_and_types()}
    assert not topics & {"/station/command", "/station/home_cmd", "/station/joint_states"}


def test_a_device_that_speaks_ros_2_itself_is_told_orders_and_one_behind_a_driver_has_no_topics(
    side: Callable[..., Side],
) -> None:
    (cell,) = plant(evidence=Evidence.JOINTS).cells
    spoken = replace(cell.roles["station"], link=Link.ROS)
    model = PlantModel(name="lab", cells=(replace(cell, members=(("station", spoken),)),))
    orchestrator, device = side("orchestrator", model), side()
    orders = device.hear(String, "station/order")
    publisher = orchestrator.port.commands.plain["station", VerbCall]
    eventually(lambda: publisher.get_subscription_count() == 2)  # one of them its own
    orchestrator.port.send(WARM)
    (told,) = eventually(lambda: orders)  # type: ignore[misc]
    assert json.loads(told.data) == {"id": "7-1", "verb": "warm", "values": {"celsius": 40.5}}
    device.say("station/order", String(data='{"verb": "go", "values": {}}'), orchestrator)
    (foreign,) = eventually(lambda: orchestrator.events)  # type: ignore[misc]
    assert isinstance(foreign, Interference)
    assert str(foreign.sentence) == "station: order go of /somebody was sent to it"
    driven = replace(cell.roles["station"], link=Link.DRIVER)
    behind = PlantModel(name="lab", cells=(replace(cell, members=(("station", driven),)),))
    orchestrator.link.close()
    device.link.close()
    side("orchestrator", behind)
    person = side()
    eventually(lambda: person.node.count_publishers("plant/heartbeat"))
    topics = {name for name, _ in person.node.get_topic_names_and_types()}
    assert [topic for topic in topics if topic.startswith("/station/")] == []
