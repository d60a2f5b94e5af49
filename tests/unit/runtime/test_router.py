"""Ports of the plant: which command and notice goes where, and how old what the bridge sends is."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from arboleda.adapters import clock
from arboleda.adapters.broker_login import Address
from arboleda.model.commands import Command, Stop, StopMode
from arboleda.model.messages import Heartbeat, MotionState, Notice
from arboleda.model.plant_model import Link, PlantModel
from arboleda.plant_file import loader
from arboleda.runtime.parts import bridge
from arboleda.runtime.parts.broker import OtherBroker
from arboleda.runtime.parts.router import NoRoute, Router
from arboleda.wire.payloads import Presence, Telemetry, encode
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Connection, Delivery, Publication

from ..kinds.lab import model

BEAT = Heartbeat(epoch=7)


class Port:
    """Notes what it is sent."""

    def __init__(self) -> None:
        self.sent: list[Command | Notice] = []

    def send(self, message: Command | Notice) -> None:
        self.sent.append(message)


def halt(robot: str) -> Stop:
    return Stop(id="7-1", robot=robot, mode=StopMode.HALT)


@pytest.fixture
def plant() -> PlantModel:
    """A bench whose oven is behind a driver, and whose eye is on MQTT."""
    (cell,) = model().cells
    oven = replace(cell.roles["oven"], link=Link.DRIVER)
    members = (("oven", oven), ("eye", cell.roles["eye"]))
    return PlantModel(name="lab", cells=(replace(cell, members=members),))


def test_a_command_goes_by_the_link_of_its_robot_and_a_notice_to_each_port_once(plant: PlantModel) -> None:
    boards, drivers = Port(), Port()
    router = Router(plant, {Link.MQTT: boards, Link.ROS: boards, Link.DRIVER: drivers})
    for message in (halt("oven"), BEAT, halt("eye")):
        router.send(message)
    assert boards.sent == [BEAT, halt("eye")]
    assert drivers.sent == [halt("oven"), BEAT]


def test_a_command_that_nothing_can_send_is_not_sent(plant: PlantModel) -> None:
    router = Router(plant, {Link.MQTT: Port()})
    with pytest.raises(NoRoute, match=r"nothing in this process reaches oven \(link: driver\)"):
        router.send(halt("oven"))


class Client:
    """In the place of the MQTT client: since when what it is given waits."""

    def __init__(self) -> None:
        self.since: list[float | None] = []

    def start(self) -> None: ...

    def publish(self, _: Publication, since: float | None = None) -> None:
        self.since.append(since)


def test_what_it_sends_counts_from_the_step_that_it_came_of(monkeypatch: pytest.MonkeyPatch) -> None:
    client = Client()
    reported_at: list[float] = []
    monkeypatch.setattr(bridge, "MqttClient", lambda *_, **__: client)
    model, now = loader.load(None), clock.seconds()
    part = bridge.BridgePart(model, 7, OtherBroker(Address(host="127.0.0.1", port=1), None), _crash)
    part.connect(lambda _report: reported_at.append(clock.seconds()))
    part.join()
    part.send(Stop(id="7-1", robot="ra1", mode=StopMode.LATCH))
    part.loop.post(Connection(at=now, client="", up=True))
    still = Telemetry(state=MotionState.STOPPED, q_deg=(0.0,) * 3, node=None)
    for channel, said in ((Channel.PRESENCE, Presence(online=True)), (Channel.TELEMETRY, still)):
        where = topic(model.robots["ra1"].mqtt, channel)
        part.loop.post(Delivery(at=now, topic=where, payload=encode(said), retain=False))
    part.loop.turn()  # its reports leave before the stop that the board, back again, may have forgotten
    (since,) = client.since
    assert since is not None and now <= since < reported_at[0]


def _crash(_: str, error: BaseException) -> Any:
    raise error
