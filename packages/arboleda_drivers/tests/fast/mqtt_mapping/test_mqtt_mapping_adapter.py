"""The driver `mqtt` where its broker is lost between two messages of one command."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.drivers import Device, NotSent, Stop, StopMode
from arboleda.wire.transport import Delivery, Publication
from arboleda_drivers.mqtt_mapping.adapter import Mqtt
from arboleda_drivers.mqtt_mapping.settings import Settings

from .mqtt_rig import device_in, plant_of

KIND = """
facts: {angle: [0, 90]}
verbs: {turn: {effect: motion, with: {to: [0, 90]}, sets: {angle: $to}, takes_s: 1, at_most_s: 8}}
"""
MAPPING = """
silent_after_s: 5
state: {hear: arm/mode, words: {stopped: idle, moving: busy}}
facts: {angle: {hear: arm/deg}}
verbs: {turn: {send: [{topic: arm/to, payload: "{to}"}, {topic: arm/speed}, {topic: arm/go}]}}
halt: [{topic: arm/stop}, {topic: arm/hold}]
"""


class Flaky(Mqtt):
    """Driver whose messages do not leave while their number is in `lost`."""

    def __init__(self, device: Device, settings: Settings, lost: set[int]) -> None:
        super().__init__(settings)
        self.left: list[str] = []
        self._lost, self._count = lost, 0
        self.hear = lambda report: None
        self.clock = lambda: 1.0
        self.begin([device], "0", "127.0.0.1:1883")
        self.connected(up=True)
        self.take(Delivery(1.0, "arm/mode", b"idle"))

    def publish(self, message: Publication) -> None:
        self._count += 1
        if self._count in self._lost:
            raise NotSent("the broker is gone")
        self.left.append(message.topic)


@pytest.fixture
def mapped(tmp_path: Path) -> tuple[Device, Settings]:
    return device_in(plant_of(tmp_path, KIND, MAPPING))


def order(device: Device) -> object:
    return device.kind.command(id="c1", robot=device.name, verb="turn", values={"to": 90})


def test_the_rest_of_an_order_never_follows_over_the_next_connection(mapped: tuple[Device, Settings]) -> None:
    device, settings = mapped
    driver = Flaky(device, settings, lost={2})
    driver.give(order(device))  # type: ignore[arg-type]
    assert driver.left == ["arm/to"]


def test_an_order_of_which_nothing_left_was_not_sent(mapped: tuple[Device, Settings]) -> None:
    device, settings = mapped
    driver = Flaky(device, settings, lost={1})
    with pytest.raises(NotSent):
        driver.give(order(device))  # type: ignore[arg-type]
    assert driver.left == []


def test_a_stop_of_which_half_left_is_to_be_given_again(mapped: tuple[Device, Settings]) -> None:
    device, settings = mapped
    driver = Flaky(device, settings, lost={2})
    with pytest.raises(NotSent):
        driver.give(Stop(id="s1", robot=device.name, mode=StopMode.HALT))
    assert driver.left == ["arm/stop"]
