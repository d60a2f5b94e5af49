"""A device of a draft is reached for: its driver listens, and what comes of it is said."""

from __future__ import annotations

import socket
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from arboleda.campaigns.draft import reaching
from arboleda.model.errors import ArboledaError
from arboleda.model.plant_model import DriverUse, Robot

from .drivers.modbus import DRIVER, ModbusWire
from .drivers.press import Order, plant

SECONDS = 20.0  # nothing waits for them but what fails
AT_ONCE = 0.2


def press(folder: Path, driver: str) -> Robot:
    return plant(folder / "plant", driver).robots["press"]


def with_driver(device: Robot, made: Callable[[], Any]) -> Robot:
    return replace(device, driver=DriverUse(name="own", make=made))


def test_a_plc_that_is_there_says_its_facts_and_is_told_nothing(tmp_path: Path) -> None:
    wire, told = ModbusWire(), list[Order]()
    wire.connect(told.append)
    beating = DRIVER % wire.port + "\n            heartbeat: {coil: 7}"
    try:
        found = reaching.reached(press(tmp_path, beating), (), SECONDS)
    finally:
        wire.close()
    assert found["reached"] and found["state"] == "stopped" and found["missing"] == []
    assert found["facts"].keys() == {"guard", "strokes"}
    assert told == []


def test_nobody_at_the_address_is_the_drivers_own_reason(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    found = reaching.reached(press(tmp_path, DRIVER % port), (), 1.0)
    assert not found["reached"] and found["why"] == f"127.0.0.1:{port} is not there"


def test_what_is_at_work_at_the_address_is_left_alone(tmp_path: Path) -> None:
    device = press(tmp_path, DRIVER % 5020)
    other = {
        "device": "mill",
        "driver": "modbus",
        "address": {"host": "127.0.0.1", "port": "5020"},
    }
    with pytest.raises(ArboledaError, match="press: mill is at work at this address"):
        reaching.reached(device, [other], SECONDS)
    with pytest.raises(ArboledaError, match="press has no driver that can be opened"):
        reaching.reached(replace(device, driver=None), [other], SECONDS)


class Broken:
    """Driver that does one thing only."""

    def __init__(self, say: Callable[[Callable[[Any], None]], None]) -> None:
        self.say = say

    def start(self, devices: Any, hear: Callable[[Any], None], clock: Any) -> None:
        self.say(hear)

    def stop(self) -> None:
        raise OSError("it is gone")


def raises(hear: Any) -> None:
    raise ConnectionRefusedError("111")


@pytest.mark.parametrize(
    ("say", "why"),
    [
        (raises, "ConnectionRefusedError: 111"),
        (lambda hear: None, "nothing was heard for 0.2 s"),
        (lambda hear: hear("hello"), "'hello' is no Report"),
    ],
)
def test_a_driver_that_does_not_get_there_says_why(
    tmp_path: Path, say: Callable[[Any], None], why: str
) -> None:
    device = with_driver(press(tmp_path, DRIVER % 5020), partial(Broken, say))
    found = reaching.reached(device, (), AT_ONCE)
    assert not found["reached"] and found["why"] == why
