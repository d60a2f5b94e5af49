"""A small plant with SCARA values and a bench that plays the broker for its boards."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import replace

import pytest

from arboleda.core.model import (
    Arm,
    Cell,
    Evidence,
    Grid,
    Joint,
    Link,
    Mobile,
    Palletizing,
    Path,
    Placement,
    PlantModel,
    Pose,
)
from arboleda.sim.devices import Devices, Reboot, ToBoard
from arboleda.wire.payloads import Payload, Telemetry, decode, encode
from arboleda.wire.topics import Channel, parse, topic
from arboleda.wire.transport import Connection, Delivery, Publication

ARM, SIX_AXES, CART, SECOND_CART = "ra_1", "ra_3", "rm_sis_a", "rm_sis_c"
AXES = {ARM: 3, SIX_AXES: 6, CART: None, SECOND_CART: None}
RADIUS_M = 0.0225
DEG = math.pi / 180


def revolute(name: str, limit_deg: float, step_deg: float, speed: float = 90, rate: float = 180) -> Joint:
    limit = limit_deg * DEG
    kinematics = {"speed": speed * DEG, "acceleration": rate * DEG, "step": step_deg * DEG}
    return Joint(name=name, lower=-limit, upper=limit, **kinematics)


SCARA = (
    revolute("q1", 150, 0.01929),
    revolute("q2", 135, 0.9),
    Joint(
        name="q3",
        lower=0.0,
        upper=0.1,
        speed=0.06,
        acceleration=0.2,
        step=0.9 * DEG * RADIUS_M,
        pinion_radius_m=RADIUS_M,
    ),
)
CR10A = tuple(revolute(f"joint{number}", 359, 0.01, 150, 300) for number in range(1, 7))


def pose(name: str, joints: tuple[Joint, ...], q1: float, q2: float) -> Pose:
    return Pose(name=name, q=(q1 * DEG, q2 * DEG, *(0.0 for _ in joints[2:])))


def cell(name: str, arm: str, joints: tuple[Joint, ...], evidence: Evidence) -> Cell:
    links = {"link": Link.MQTT, "evidence": evidence}
    here = Placement(x=0.0, y=0.0)
    pickup, place = pose("pickup", joints, 45, 10), pose("8", joints, 20, 20)
    return Cell(
        name=name,
        arm=Arm(
            name=arm.replace("_", ""),
            mqtt=arm,
            timeout_s=10,
            model="test",
            twin="r1",
            base=here,
            joints=joints,
            **links,
        ),
        mobile=Mobile(
            name=f"rm_{name}",
            mqtt=f"rm_{name}",
            timeout_s=20,
            grid=Grid(origin=here, pitch=0.2),
            speed=0.2,
            **links,
        ),
        home=pose("home", joints, 0, 0),
        pickup=pickup,
        stations=(place,),
        paths=(Path(code="0B", nodes=(0, 3, 4, 7)),),
        palletizing=Palletizing(pick=pickup, place=place),
        queue_limit=8,
    )


def plant(evidence: Evidence = Evidence.IDS, **of_every_robot: object) -> PlantModel:
    cells = (cell("sis_a", ARM, SCARA, evidence), cell("sis_c", SIX_AXES, CR10A, evidence))
    changed = (
        replace(c, arm=replace(c.arm, **of_every_robot), mobile=replace(c.mobile, **of_every_robot))
        for c in cells
    )
    return PlantModel(name="test", cells=tuple(changed))


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
        said = ((parse(sent.topic)[1], sent.payload) for sent in self.published[board])
        return [
            decode(channel, raw, axes=AXES[board]) for channel, raw in said if channel is Channel.TELEMETRY
        ]

    def last(self, board: str) -> Telemetry:
        return self.heard(board)[-1]


@pytest.fixture
def model() -> PlantModel:
    """Two cells at `ids`, with a SCARA and a CR10A."""
    return plant()


@pytest.fixture
def bench(model: PlantModel) -> Bench:
    """Its boards, connected."""
    return connected(model)


@pytest.fixture
def make_bench() -> Callable[..., Bench]:
    """`make_bench(evidence, **fields of every robot)`: connected boards of another plant."""
    return lambda *args, **fields: connected(plant(*args, **fields))


def connected(model: PlantModel) -> Bench:
    bench = Bench(model)
    for board in bench.devices.boards:
        bench.connect(board)
    return bench
