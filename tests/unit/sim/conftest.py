"""A bench that plays the broker for the boards of two shipped cells, one with each arm."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import pytest

from arboleda.model.plant_model import PlantModel
from arboleda.sim.devices import Devices, Reboot, ToBoard
from arboleda.testing import shipped
from arboleda.wire.payloads import Payload, Telemetry, decode, encode
from arboleda.wire.topics import Channel, parse, topic
from arboleda.wire.transport import Connection, Delivery, Publication


class Bench:
    """Devices, a clock moved by hand, and everything the boards published."""

    def __init__(self, model: PlantModel, *, start: float = 1000.0) -> None:
        ids = itertools.count(100)
        self.now = start
        self.devices = Devices(model, now=start, boot_ids=lambda: next(ids))
        self.published: dict[str, list[Publication]] = {name: [] for name in self.devices.boards}

    def step(self, *events: ToBoard | Reboot) -> None:
        for sent in self.devices.step(self.now, events):
            self.published[sent.board].append(sent.publication)

    def run(self, seconds: float) -> None:
        """Let time pass from deadline to deadline, as a loop does."""
        end = self.now + seconds
        while (due := self.devices.next_deadline) is not None and due <= end:
            self.now = max(self.now, due)
            self.step()
        self.now = end
        self.step()

    def connect(self, board: str, up: bool = True) -> None:
        self.step(ToBoard(board=board, event=Connection(at=self.now, client=board, up=up)))

    def send(self, board: str, channel: Channel, payload: Payload | bytes, *, retain: bool = False) -> None:
        raw = payload if isinstance(payload, bytes) else encode(payload)
        delivery = Delivery(at=self.now, topic=topic(board, channel), payload=raw, retain=retain)
        self.step(ToBoard(board=board, event=delivery))

    def reboot(self, board: str) -> None:
        self.step(Reboot(at=self.now, board=board))

    def heard(self, board: str) -> list[Telemetry]:
        """All telemetry of a board so far."""
        axes = self.devices.boards[board].body.axes
        said = ((parse(sent.topic)[1], sent.payload) for sent in self.published[board])
        return [decode(channel, raw, axes=axes) for channel, raw in said if channel is Channel.TELEMETRY]

    def last(self, board: str) -> Telemetry:
        return self.heard(board)[-1]


def connected(**declared: Any) -> Bench:
    """The boards of sis_a and sis_c (a SCARA, a CR10A and their mobiles), connected."""
    bench = Bench(shipped("sis_a", "sis_c", **declared))
    for board in bench.devices.boards:
        bench.connect(board)
    return bench


@pytest.fixture
def bench() -> Bench:
    """Connected boards, as shipped."""
    return connected()


@pytest.fixture(scope="session")
def make_bench() -> Callable[..., Bench]:
    """`make_bench(has_stop=False)`: connected boards of robots that declare this."""
    return connected
