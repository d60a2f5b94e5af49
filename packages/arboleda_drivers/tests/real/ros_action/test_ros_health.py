"""The health of an arm over real ROS 2: publishers of each quality of service, services."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from tests.contract.conftest import Inbox

from arboleda_drivers.ros_action.health import Call, CallAnswer, Health, HealthReading

pytestmark = pytest.mark.system

UNLOCK = Call(service="unlock", type="std_srvs/srv/SetBool", request={"data": True})
ABSENT = Call(service="absent", type="std_srvs/srv/Trigger")
HEALTH = Health(
    topic="safety_mode", type="std_msgs/msg/Int32", field="data", well=(1,), clear=(UNLOCK, ABSENT)
)


@pytest.fixture
def node(require: Callable[[str], None], ros_domain: Any) -> Iterator[Callable[[str], Any]]:
    """A function that makes a node of a name; all of them turn in one thread, which is not started yet."""
    require("rclpy")
    from arboleda_ros.link import connect

    links: list[Any] = []

    def made(name: str) -> tuple[Any, Any]:
        link = connect()
        links.append(link)
        return link, link.node(name)

    yield made
    for link in links:
        link.close()


@pytest.mark.parametrize(
    ("durability", "reliability"), [("VOLATILE", "BEST_EFFORT"), ("TRANSIENT_LOCAL", "RELIABLE")]
)
def test_a_value_is_read_whatever_the_publisher_s_quality_of_service(
    node: Callable[[str], Any], durability: str, reliability: str
) -> None:
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
    from std_msgs.msg import Int32

    from arboleda_drivers.ros_action.health_link import HealthLink

    profile = QoSProfile(
        depth=1,
        durability=getattr(DurabilityPolicy, durability),
        reliability=getattr(ReliabilityPolicy, reliability),
    )
    hardware, its = node("hardware")
    publisher = its.create_publisher(Int32, HEALTH.topic, profile)
    is_kept = (durability, reliability) == ("TRANSIENT_LOCAL", "RELIABLE")
    if is_kept:
        publisher.publish(Int32(data=3))  # before anybody listens, and never again
    else:
        its.create_timer(0.02, lambda: publisher.publish(Int32(data=3)))
    driver, ours = node("driver")
    inbox = Inbox()
    HealthLink(ours, HEALTH, lambda message, event: inbox.put(event))
    hardware.start()
    driver.start()
    inbox.wait(lambda events: HealthReading(value=3) in events)


def test_calls_are_answered_with_their_text_and_one_that_nobody_serves_is_told(
    node: Callable[[str], Any],
) -> None:
    from std_srvs.srv import SetBool

    from arboleda_drivers.ros_action.health_link import HealthLink

    requests: list[bool] = []

    def serve(request: Any, response: Any) -> Any:
        requests.append(request.data)
        response.success, response.message = len(requests) > 1, "5 s have to pass"
        return response

    hardware, its = node("hardware")
    its.create_service(SetBool, UNLOCK.service, serve)
    driver, ours = node("driver")
    inbox = Inbox()
    link = HealthLink(ours, HEALTH, lambda message, event: inbox.put(event))
    hardware.start()
    driver.start()
    absent = CallAnswer(call=UNLOCK, ok=False, text="is not there")
    refused = CallAnswer(call=UNLOCK, ok=False, text="5 s have to pass")
    while refused not in inbox:  # until both have found each other
        count = len(inbox)
        ours.executor.create_task(link.make, UNLOCK)
        inbox.wait(lambda events, count=count: len(events) > count)
    ours.executor.create_task(link.make, UNLOCK)
    inbox.wait(lambda events: any(each.ok for each in events))
    assert set(requests) == {True}
    assert all(each in (absent, refused) or each.ok for each in inbox)
    ours.executor.create_task(link.make, ABSENT)
    inbox.wait(lambda events: CallAnswer(call=ABSENT, ok=False, text="is not there") in events)
