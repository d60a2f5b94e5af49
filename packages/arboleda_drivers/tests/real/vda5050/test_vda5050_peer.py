"""The driver vda5050 with a vehicle that we did not write, that of vda-5050-lib, at a mosquitto."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.contract.conftest import Inbox, Mosquitto
from tests.patience import PATIENCE_S

from arboleda.adapters.mqtt import MqttClient
from arboleda.drivers import FollowPath, MotionState, Report, Stop, StopMode
from arboleda.kinds.declared import Device
from arboleda.model.facts import Value
from arboleda.model.plant_model import Robot
from arboleda.plant_file.loader import load
from arboleda.wire.transport import Delivery
from arboleda_drivers.vda5050.adapter import Vda5050
from arboleda_drivers.vda5050.settings import EdgeAction, Settings

pytestmark = [pytest.mark.system, pytest.mark.requires("node")]

LIBRARY = Path(sys.prefix, "npm/node_modules/vda-5050-lib")
VEHICLE = Path(__file__).with_name("virtual_agv.js")
TOPICS = "uagv/v2/peer/agv1"
PLANT = """
name: hall
uses: [recipes.py]
kinds:
  forks:
    facts: {loaded: bool, charging: bool, battery: number}
    verbs:
      pick:
        effect: switch
        with: {station_type: [floor], load_type: [EPAL, none], duration: [0.1, 9]}
        sets: {loaded: true}
        takes_s: 1
        at_most_s: 20
      noop: {effect: process, with: {duration: [0.1, 9]}, takes_s: 1, at_most_s: 20}
      dance: {effect: process, takes_s: 1, at_most_s: 20}
      start_charging:
        {effect: process, with: {duration: [0.1, 9]}, sets: {charging: true}, takes_s: 1, at_most_s: 20}
      stop_charging:
        {effect: process, with: {duration: [0.1, 9]}, sets: {charging: false}, takes_s: 1, at_most_s: 20}
cells:
  hall:
    devices:
      cart: {kind: mobile, grid: {pitch_mm: 400}}
      forks: {kind: forks}
    targets: {home: {cart: {node: 0}}}
"""
RECIPES = """
from arboleda.recipes import recipe

@recipe("home")
def home(cell):
    return cell.device("cart").go("home")
"""
INSTANT = ("noop", "stop_charging")
EDGES = (EdgeAction(between=("0", "3"), action="noop", values={"duration": 0.1}),)


class Hall:
    """The driver with a cart and its forks, the vehicle's process, and what is said at the broker."""

    def __init__(self, robots: dict[str, Robot], broker: Mosquitto, node: str) -> None:
        self._robots, self._broker, self._node = robots, broker, node
        self.reports = Inbox()
        self._reports_before = 0
        self.wire = Inbox()
        self._spy = MqttClient("spy", broker.address, on_event=self.wire.put, subscriptions=[f"{TOPICS}/#"])
        self._spy.start()
        self.wire.wait(lambda inbox: any(inbox.links))
        where = f"{broker.address.host}:{broker.address.port}"
        vehicle = {"broker": where, "manufacturer": "peer", "serial": "agv1", "version": "2.0"}
        settings = Settings(base=1, instant=INSTANT, edges=EDGES, **vehicle)  # type: ignore[arg-type]
        self._driver = Vda5050(settings)
        self._driver.start(list(robots.values()), self.reports.put, time.monotonic)
        self.vehicle = self.boot()

    def boot(self) -> subprocess.Popen[bytes]:
        self._mark()
        url = f"mqtt://{self._broker.address.host}:{self._broker.address.port}"
        self.vehicle = subprocess.Popen([self._node, VEHICLE, LIBRARY, url, "agv1"])
        return self.vehicle

    def close(self) -> None:
        self._driver.stop()
        self.vehicle.kill()
        self.vehicle.wait()
        self._spy.close()

    def drive(self, id: str, *nodes: int) -> None:
        self._mark()
        self._driver.send(FollowPath(id=id, robot="cart", nodes=nodes))

    def do(self, id: str, verb: str, **values: Value) -> None:
        forks = self._robots["forks"]
        assert isinstance(forks, Device)
        self._mark()
        self._driver.send(forks.kind.command(id=id, robot="forks", verb=verb, values=values))

    def stop(self, mode: StopMode) -> None:
        self._mark()
        self._driver.send(Stop(id="", robot="cart", mode=mode))

    def _mark(self) -> None:
        """Reports from here on may answer what is sent next; its answer may come before anybody waits."""
        self._reports_before = len(self.reports)

    def hears(self, robot: str, **wanted: object) -> Report:
        """The first report of a robot, after what was sent last, that says all of this."""

        def found(reports: Inbox) -> Report | None:
            mine = (each for each in reports[self._reports_before :] if each.robot == robot)
            return next(
                (each for each in mine if all(getattr(each, key) == wanted[key] for key in wanted)), None
            )

        return self.reports.wait(found)

    def told(self, topic: str) -> list[Any]:
        """All messages of a topic so far."""
        sent = [each for each in list(self.wire) if isinstance(each, Delivery) and each.topic.endswith(topic)]
        return [json.loads(each.payload) for each in sent]


@pytest.fixture
def hall(
    mosquitto: Callable[..., Mosquitto], require: Callable[[str], str], tmp_path: Path
) -> Iterator[Hall]:
    """The vehicle stands at node 0, and is heard."""
    if not LIBRARY.is_dir():
        pytest.skip("vda-5050-lib is not installed: make test-tools")
    for name, text in (("plant.yaml", PLANT), ("recipes.py", RECIPES)):
        (tmp_path / name).write_text(text, "utf-8")
    broker = mosquitto()
    broker.start()
    hall = Hall(dict(load(tmp_path / "plant.yaml").robots), broker, require("node"))
    try:
        hall.hears("cart", state=MotionState.STOPPED, node=0, homed=True)
        yield hall
    finally:
        hall.close()


def test_a_way_is_driven_by_updates_as_long_as_its_factsheet_takes_them(
    hall: Hall, caplog: pytest.LogCaptureFixture
) -> None:
    assert told_in_log(caplog, "factsheet") == [
        "peer/agv1 by its factsheet: it has no action dance at a node, which is for forks dance;"
        " it has noop, startCharging, stopCharging, pick"
    ]
    hall.drive("1-1", 0, 1, 2, 5, 8)
    hall.hears("cart", accepted="1-1", state=MotionState.MOVING)
    assert hall.hears("cart", done="1-1").node == 8
    orders = hall.told("/order")
    assert [each["orderUpdateId"] for each in orders] == list(range(len(orders)))
    assert len(orders) > 1 and max(len(each["nodes"]) for each in orders) == 3
    assert any(state["driving"] and state["orderUpdateId"] for state in hall.told("/state"))


def told_in_log(caplog: pytest.LogCaptureFixture, word: str) -> list[str]:
    """Lines with a word, also those of before the test began; waits for the first."""
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        lines = [each.getMessage() for each in (*caplog.get_records("setup"), *caplog.records)]
        if found := [line for line in lines if word in line]:
            return found
        time.sleep(0.02)
    return []


def test_actions_are_done_at_a_node_on_an_edge_and_at_once_on_the_way(hall: Hall) -> None:
    hall.do("1-1", "pick", station_type="floor", load_type="EPAL", duration=0.1)
    assert hall.hears("forks", done="1-1").fact("loaded") is True
    hall.drive("1-2", 0, 3)
    hall.hears("cart", accepted="1-2")
    hall.do("1-3", "noop", duration=0.1)
    assert hall.hears("forks", done="1-3").done == "1-3"
    assert hall.hears("cart", done="1-2").node == 3
    (edge,) = hall.told("/order")[-1]["edges"]
    states = [each for state in hall.told("/state") for each in state["actionStates"]]
    (horn,) = edge["actions"]
    assert (horn["actionId"], "FINISHED") in {(each["actionId"], each["actionStatus"]) for each in states}


def test_what_it_does_not_know_or_cannot_do_now_is_rejected(hall: Hall) -> None:
    hall.do("1-1", "pick", station_type="floor", load_type="none", duration=0.1)
    assert hall.hears("forks", rejected="1-1").refusal == "orderError"
    hall.do("1-2", "dance")
    assert hall.hears("forks", rejected="1-2").refusal == "orderError"
    hall.do("1-3", "start_charging", duration=0.1)
    assert hall.hears("forks", done="1-3").fact("charging") is True
    hall.drive("1-4", 0, 1)
    assert hall.hears("cart", rejected="1-4").refusal == "orderError"
    hall.do("1-5", "stop_charging", duration=0.1)
    assert hall.hears("forks", done="1-5").fact("charging") is False
    hall.drive("1-6", 0, 1)
    assert hall.hears("cart", done="1-6").node == 1


def test_after_a_halt_and_after_a_latch_the_next_order_begins_where_it_stands(hall: Hall) -> None:
    hall.drive("1-1", 0, 1, 2)
    hall.hears("cart", accepted="1-1")
    hall.stop(StopMode.HALT)
    stood = hall.hears("cart", state=MotionState.STOPPED)
    assert stood.done is None and stood.node != 2
    hall.drive("1-2", 0, 1, 2)
    hall.hears("cart", accepted="1-2")
    hall.stop(StopMode.LATCH)
    assert hall.hears("cart", state=MotionState.STOP_LATCHED).done is None
    hall.stop(StopMode.CLEAR)
    hall.hears("cart", state=MotionState.STOPPED)
    hall.drive("1-3", 0, 3)
    assert hall.hears("cart", done="1-3").node == 3


def test_a_killed_vehicle_is_lost_by_its_last_will_and_back_without_its_order(hall: Hall) -> None:
    hall.drive("1-1", 0, 1, 2)
    hall.hears("cart", accepted="1-1")
    hall.vehicle.kill()
    hall.vehicle.wait()
    assert "the connection of peer/agv1 broke" in str(hall.hears("cart", state=MotionState.NO_LINK).lost)
    hall.boot()
    back = hall.hears("cart", state=MotionState.STOPPED)
    assert (back.node, back.accepted, back.done) == (0, None, None)
