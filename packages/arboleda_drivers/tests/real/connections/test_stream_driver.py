"""The thread of a driver at streams: whatever finds that a stream is due, it is opened."""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from typing import Any

import pytest
from tests.patience import PATIENCE_S

from arboleda.drivers import Robot, Stop, StopMode
from arboleda.testing import shipped
from arboleda_drivers.connections.link import CommandRequest, Open
from arboleda_drivers.connections.stream_driver import MachineDriver

pytestmark = pytest.mark.system


class OpensForCommands:
    """Machine that wants its streams opened by what a command makes due."""

    next_deadline = math.inf

    def step(self, now: float, events: Sequence[Any]) -> list[Any]:
        return [Open() for event in events if isinstance(event, CommandRequest)]


class Counting(MachineDriver):
    """Driver whose streams are never there, and that says when it looks for them."""

    def __init__(self) -> None:
        super().__init__()
        self.looked = threading.Event()

    def machine(self, devices: Sequence[Robot]) -> Any:
        return OpensForCommands()

    def connect(self) -> Any:
        self.looked.set()
        raise OSError("nobody is there")

    def write(self, message: object) -> None: ...


def test_a_stop_that_makes_a_stream_due_has_it_opened() -> None:
    driver = Counting()
    driver.start([*shipped().robots.values()][:1], lambda report: None, lambda: 0.0)
    try:
        driver.send(Stop(id="s1", robot="r", mode=StopMode.HALT))
        assert driver.looked.wait(PATIENCE_S)
    finally:
        driver.stop()
