"""The driver `ros` over ROS 2, by types that every ROS 2 has: a service, what is published, a topic."""

from __future__ import annotations

import queue
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.patience import PATIENCE_S

from arboleda.drivers import Device, MotionState, Report
from arboleda.plant_file.loader import load
from arboleda_drivers.ros_mapping.adapter import RosMapping

pytestmark = [pytest.mark.system, pytest.mark.smoke]
PLANT = """
name: doors
uses: [recipes.py]
kinds:
  door:
    facts: {leaf: [open, shut], lamp: bool}
    verbs:
      move: {effect: process, with: {leaf: [open, shut]}, sets: {leaf: $leaf}, at_most_s: 20, on_stop: finish}
      light: {effect: switch, with: {lamp: bool}, sets: {lamp: $lamp}}
      ask: {effect: query, answers: [good, bad]}
cells:
  hall:
    devices:
      door:
        kind: door
        driver:
          ros:
            namespace: /door
            verbs:
              move:
                service: move
                type: std_srvs/srv/SetBool
                fields: {data: {value: $leaf, words: {open: true, shut: false}}}
                done: {success: true}
                failure: {field: message}
              light: {publish: lamp, type: std_msgs/msg/Bool, fields: {data: $lamp}}
              ask: {service: ask, type: std_srvs/srv/Trigger, answer: {field: message}}
            facts:
              leaf: {topic: leaf, type: std_msgs/msg/String, field: data}
              lamp: {done: true}
"""
RECIPES = """
from arboleda.recipes import recipe

@recipe("move")
def move(cell):
    return cell.device("door").move(leaf="open")
"""


class Door:
    """A node with the services and the topics; the leaf is told once, to all who come later as well."""

    def __init__(self) -> None:
        from std_msgs.msg import Bool, String
        from std_srvs.srv import SetBool, Trigger

        from arboleda_ros.link import connect
        from arboleda_ros.qos import VIEW

        self.lamps, self.fails = queue.Queue[bool](), ""
        self._string, self._link = String, connect()
        node = self._link.node("door")
        self._leaf = node.create_publisher(String, "/door/leaf", VIEW)
        node.create_subscription(Bool, "/door/lamp", lambda message: self.lamps.put(message.data), 10)
        node.create_service(SetBool, "/door/move", self._move)
        node.create_service(Trigger, "/door/ask", self._ask)
        self._leaf.publish(String(data="shut"))
        self._link.start()

    def close(self) -> None:
        self._link.close()

    def _move(self, request: Any, response: Any) -> Any:
        response.success, response.message = not self.fails, self.fails
        if response.success:
            self._leaf.publish(self._string(data="open" if request.data else "shut"))
        return response

    def _ask(self, request: Any, response: Any) -> Any:
        response.message = "good"
        return response


class Driven:
    """The driver of the door, and what it reports."""

    def __init__(self, folder: Path) -> None:
        (folder / "plant.yaml").write_text(PLANT, "utf-8")
        (folder / "recipes.py").write_text(RECIPES, "utf-8")
        device = load(folder / "plant.yaml").robots["door"]
        assert isinstance(device, Device) and device.driver is not None
        self.device, self.reports = device, queue.Queue[Report]()
        self.driver: RosMapping = device.driver.make()
        self.driver.start([device], self.reports.put, time.monotonic)

    def tell(self, id: str, verb: str, **values: Any) -> None:
        self.driver.send(self.device.kind.command(id=id, robot="door", verb=verb, values=values))

    def until(self, so: Callable[[Report], bool]) -> Report:
        until = time.monotonic() + PATIENCE_S
        while time.monotonic() < until:
            if so(report := self.reports.get(timeout=PATIENCE_S)):
                return report
        pytest.fail("it was not reported")


@pytest.fixture
def door(ros_domain: int, quick_discovery: None) -> Iterator[Door]:
    played = Door()
    yield played
    played.close()


@pytest.fixture
def driven(door: Door, tmp_path: Path) -> Iterator[Driven]:
    driven = Driven(tmp_path)
    yield driven
    driven.driver.stop()


def test_a_service_a_message_and_a_question_do_what_they_say(door: Door, driven: Driven) -> None:
    first = driven.until(lambda report: report.fact("leaf") == "shut")
    assert first.state is MotionState.STOPPED and first.unknown == ("lamp",)
    driven.tell("1-1", "move", leaf="open")
    assert driven.until(lambda report: report.done == "1-1").fact("leaf") == "open"
    driven.tell("1-2", "light", lamp=True)
    assert door.lamps.get(timeout=PATIENCE_S) is True
    assert driven.until(lambda report: report.done == "1-2").fact("lamp") is True
    driven.tell("1-3", "ask")
    assert driven.until(lambda report: report.answered == "1-3").answer == "good"
    door.fails = "no air"
    driven.tell("1-4", "move", leaf="shut")
    assert driven.until(lambda report: report.failed == "1-4").failure == "no air"


def test_a_node_that_ends_is_told_and_comes_back_as_a_boot(door: Door, driven: Driven) -> None:
    before = driven.until(lambda report: report.state is MotionState.STOPPED)
    door.close()
    gone = driven.until(lambda report: report.state is MotionState.NO_LINK)
    assert "/door/" in str(gone.lost)
    again = Door()
    back = driven.until(lambda report: report.state is MotionState.STOPPED)
    assert back.boot_id != before.boot_id
    again.close()
