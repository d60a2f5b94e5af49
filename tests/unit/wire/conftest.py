"""A bridge to one shipped cell, whose time, plant, broker and boards are moved by hand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from arboleda.model.commands import Command
from arboleda.model.messages import Heartbeat, MotionState, Report
from arboleda.model.plant_model import Evidence
from arboleda.testing import shipped
from arboleda.wire.bridge import Bridge, Message
from arboleda.wire.hop import FromPlant
from arboleda.wire.payloads import Payload, Presence, Telemetry, decode, encode
from arboleda.wire.topics import Channel, parse, topic
from arboleda.wire.transport import Connection, Delivery, Publication

EPOCH = 1_000


class Bench:
    """Drives a bridge and remembers what came out of it; `now` only moves where a test says so."""

    def __init__(self, *, epoch: int = EPOCH, has_lease: bool = False, **declared: Any) -> None:
        self.model = shipped("sis_a", **declared)
        self.now = 100.0
        self.bridge = Bridge(self.model, epoch=epoch, now=self.now, has_lease=has_lease)
        self._beaten = False
        self._told: dict[str, Telemetry] = {}
        self.start = self.step()

    def step(self, *events: object) -> list[Message]:
        return self.bridge.step(self.now, events)  # type: ignore[arg-type]

    def wait(self, seconds: float) -> list[Message]:
        self.now += seconds
        return self.step()

    def connect(self, up: bool = True) -> list[Message]:
        return self.step(Connection(at=self.now, client="bridge", up=up))

    def order(self, *commands: Command) -> list[Message]:
        """The plant's commands; one that says who it is has been heard beating before."""
        if not self._beaten and any(command.id for command in commands):
            self.heartbeat()
        return self.step(*(FromPlant(at=self.now, message=command) for command in commands))

    def heartbeat(self, epoch: int = 7) -> list[Message]:
        self._beaten = True
        return self.step(FromPlant(at=self.now, message=Heartbeat(epoch=epoch)))

    def deliver(self, address: str, payload: bytes, *, retain: bool = False) -> list[Message]:
        return self.step(Delivery(at=self.now, topic=address, payload=payload, retain=retain))

    def presence(self, online: bool, robot: str = "ra_1") -> list[Message]:
        return self.deliver(topic(robot, Channel.PRESENCE), encode(Presence(online=online)), retain=True)

    def tell(self, robot: str = "ra_1", **changes: object) -> list[Message]:
        """The board's next telemetry: what it said last time, with these changes, 100 ms later."""
        self.now += 0.1
        said = replace(self._told.get(robot, self._first(robot)), **changes)  # type: ignore[arg-type]
        if said.seq is not None and "seq" not in changes:
            said = replace(said, seq=said.seq + 1)
        self._told[robot] = said
        return self.deliver(topic(robot, Channel.TELEMETRY), encode(said))

    def _first(self, robot: str) -> Telemetry:
        arm = robot.startswith("ra")
        ids = self.model.robots["ra1"].evidence is Evidence.IDS
        return Telemetry(
            state=MotionState.STOPPED,
            q_deg=(0.0, 0.0, 0.0) if arm else None,
            node=None if arm else 0,
            seq=0 if ids else None,
            boot_id=1 if ids else None,
            least_epoch=EPOCH if ids else None,
            homed=True if ids else None,
        )


def reports(messages: list[Message]) -> list[Report]:
    return [message for message in messages if isinstance(message, Report)]


def sent(messages: list[Message]) -> list[tuple[str, Payload]]:
    """The publications as (board/channel, payload)."""
    out = []
    for message in messages:
        if isinstance(message, Publication):
            board, channel = parse(message.topic)
            axes = 3 if board.startswith("ra") else None
            out.append((message.topic, decode(channel, message.payload, axes=axes)))
    return out


@pytest.fixture
def bench() -> Bench:
    """A bridge that has just started: not connected, nothing heard."""
    return Bench()


@pytest.fixture(scope="session")
def make_bench() -> type[Bench]:
    """`make_bench(epoch=2000)`: another bridge that has just started."""
    return Bench


@pytest.fixture
def linked() -> Bench:
    """Connected, both robots heard."""
    return link(Bench())


@pytest.fixture(scope="session")
def make_linked() -> Callable[..., Bench]:
    """`make_linked(has_stop=False)`: connected, both robots heard; they declare this."""
    return lambda **declared: link(Bench(**declared))


def link(bench: Bench) -> Bench:
    bench.connect()
    bench.tell("ra_1")
    bench.tell("rm_sis_a")
    return bench


@pytest.fixture(scope="session", name="reports")
def _reports() -> Callable[[list[Message]], list[Report]]:
    return reports


@pytest.fixture(scope="session", name="sent")
def _sent() -> Callable[[list[Message]], list[tuple[str, Payload]]]:
    return sent
