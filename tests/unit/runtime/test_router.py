"""The plant's port: a command goes to whatever reaches its robot, a notice to all of them."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.model.commands import Command, Stop, StopMode
from arboleda.model.messages import Heartbeat, Notice
from arboleda.model.plant_model import Link, PlantModel
from arboleda.runtime.parts.router import NoRoute, Router

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
