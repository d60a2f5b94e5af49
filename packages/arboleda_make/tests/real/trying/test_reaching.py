"""A device of a draft is reached for: its driver listens, and what comes of it is said."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from packages.arboleda_drivers.tests.real.contract.press import Order, plant
from packages.arboleda_drivers.tests.real.modbus.bench import DRIVER, PlayedModbus

from arboleda.drivers import lost
from arboleda.model.plant_model import DriverUse, Robot
from arboleda_make.trying.processes import reaching

SECONDS = 20.0  # nothing waits for them but what fails
AT_ONCE = 0.2


def press(folder: Path, driver: str) -> Robot:
    return plant(folder / "plant", driver).robots["press"]


def test_a_plc_that_is_there_says_its_facts_and_is_told_nothing(tmp_path: Path) -> None:
    wire, told = PlayedModbus(), list[Order]()
    wire.connect(told.append)
    beating = DRIVER % wire.port + "\n            heartbeat: {coil: 7}"
    try:
        found = reaching.reached(press(tmp_path, beating), (), SECONDS)
    finally:
        wire.close()
    assert found["reached"] and found["state"] == "stopped" and found["missing"] == []
    assert found["facts"].keys() == {"guard", "strokes"}
    assert told == []


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


WHY: dict[str, Callable[[Any], None]] = {
    "ConnectionRefusedError: 111": raises,
    "the mill is not there": lambda hear: hear(lost("press", at=0.0, why="the mill is not there")),
    "nothing was heard for 0.2 s": lambda hear: None,
    "'hello' is no Report": lambda hear: hear("hello"),
}


def test_a_driver_that_does_not_get_there_says_why(tmp_path: Path) -> None:
    device = press(tmp_path, DRIVER % 5020)
    found = {
        why: reaching.reached(
            replace(device, driver=DriverUse(name="own", make=partial(Broken, say))), (), AT_ONCE
        )
        for why, say in WHY.items()
    }
    assert {why: row["why"] for why, row in found.items()} == {why: why for why in WHY}
    assert not any(row["reached"] for row in found.values())
