"""The virtual boards of a real start, with mishaps that a person begins; time is moved by hand."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest

from arboleda.model.messages import MotionState
from arboleda.plant_file import loader
from arboleda.sim.devices import Devices, FromBoard, ToBoard
from arboleda.testing import shipped
from arboleda.wire.payloads import EffectorGoal, JointsGoal, Payload, Telemetry, decode, encode
from arboleda.wire.topics import Channel, parse, topic
from arboleda.wire.transport import Connection, Delivery
from arboleda_proofs.simulator.fault_bench import (
    FaultBench,
    MishapBegins,
    MishapEnds,
    MishapNote,
    MishapOver,
)
from arboleda_proofs.simulator.faults.targets import arm_body
from arboleda_proofs.simulator.mishaps import MISHAPS

NUMBERS = itertools.count(1)
MILL = Path(__file__).parents[5] / "examples" / "machine_tending" / "plant.yaml"


class Start:
    """Start: the bench, a clock moved by hand, and what came out of it."""

    def __init__(self, model=None) -> None:
        model, ids = model or shipped("sis_a", "sis_c"), itertools.count(100)
        self.now = 1000.0
        devices = Devices(model, now=self.now, boot_ids=lambda: next(ids))
        self.bench = FaultBench(model, devices, now=self.now)
        self.heard: list[FromBoard | MishapNote | MishapOver] = []
        self.seq = itertools.count(1)
        self.step(*(ToBoard(board=name, event=self.link(name)) for name in self.bench.boards))

    def link(self, board: str, *, up: bool = True) -> Connection:
        return Connection(at=self.now, client=board, up=up)

    def step(self, *events) -> None:
        self.heard += self.bench.step(self.now, events)

    def run(self, seconds: float) -> None:
        """Let time pass from deadline to deadline, as a loop does."""
        end = self.now + seconds
        while (due := self.bench.next_deadline) is not None and due <= end:
            self.now = max(self.now, due)
            self.step()
        self.now = end
        self.step()

    def begin(self, name: str, board: str = "ra_1", seconds: float = 0.0) -> int:
        number = next(NUMBERS)
        self.step(MishapBegins(number=number, name=name, board=board, seconds=seconds))
        return number

    def send(self, channel: Channel, payload: Payload, board: str = "ra_1") -> None:
        raw = encode(payload)
        delivery = Delivery(at=self.now, topic=topic(board, channel), payload=raw)
        self.step(ToBoard(board=board, event=delivery))

    def move(self, q: float = 45.0) -> None:
        self.send(Channel.JOINTS, JointsGoal(q_deg=(q, 9.0, 0.0), seq=next(self.seq), epoch=5))

    def switch(self, *, on: bool) -> None:
        self.send(Channel.EFFECTOR, EffectorGoal(on=on, seq=next(self.seq), epoch=5))

    def published(self, channel: Channel, board: str = "ra_1") -> list[bytes]:
        sent = [
            each.publication for each in self.heard if isinstance(each, FromBoard) and each.board == board
        ]
        return [each.payload for each in sent if parse(each.topic)[1] is channel]

    def telemetry(self, board: str = "ra_1") -> list[Telemetry]:
        axes = self.bench.boards[board].body.axes
        return [decode(Channel.TELEMETRY, raw, axes=axes) for raw in self.published(Channel.TELEMETRY, board)]

    @property
    def notes(self) -> list[tuple[str, str, bool]]:
        found = [each for each in self.heard if isinstance(each, MishapNote)]
        return [(each.name, each.board, each.is_over) for each in found]


@pytest.fixture
def start() -> Start:
    return Start()


def test_without_a_mishap_the_boards_do_what_they_do_alone(start: Start) -> None:
    model, ids = shipped("sis_a", "sis_c"), itertools.count(100)
    alone, heard = Devices(model, now=1000.0, boot_ids=lambda: next(ids)), []
    heard += alone.step(1000.0, [ToBoard(board=each, event=start.link(each)) for each in alone.boards])
    raw = encode(JointsGoal(q_deg=(45.0, 9.0, 0.0), seq=1, epoch=5))
    sent = Delivery(at=1000.0, topic=topic("ra_1", Channel.JOINTS), payload=raw)
    heard += alone.step(1000.0, [ToBoard(board="ra_1", event=sent)])
    start.move()
    while (due := alone.next_deadline) <= 1003.0:
        heard += alone.step(due, ())
    start.run(3.0)
    assert heard == start.heard[: len(heard)]
    assert len(heard) > 60


def test_a_reboot_is_over_at_once_and_the_broker_tells_it(start: Start) -> None:
    boot = start.telemetry()[-1].boot_id
    start.begin("reboot")
    start.run(0.3)
    assert start.published(Channel.PRESENCE)[-2:] == [b"0", b"1"]
    assert start.telemetry()[-1].boot_id != boot
    assert start.telemetry()[-1].homed is False
    assert start.notes == [("reboot", "ra_1", False)]
    assert not start.bench.begun


def test_a_board_without_power_hears_nothing_and_boots_by_itself_when_the_time_is_over(start: Start) -> None:
    start.begin("no_power", seconds=2.0)
    said = len(start.telemetry())
    start.move()
    start.run(1.9)
    assert start.published(Channel.PRESENCE)[-1] == b"0"
    assert len(start.telemetry()) == said
    assert len(start.telemetry("rm_sis_a")) > 15
    start.run(0.3)
    assert start.published(Channel.PRESENCE)[-1] == b"1"
    assert start.telemetry()[-1].ack in (None, 0)
    assert start.notes == [("no_power", "ra_1", False), ("no_power", "ra_1", True)]


def test_a_board_whose_client_lost_the_broker_meanwhile_says_nothing_when_it_has_power_again(
    start: Start,
) -> None:
    start.begin("no_power", seconds=1.0)
    start.step(ToBoard(board="ra_1", event=start.link("ra_1", up=False)))
    start.run(2.0)
    assert start.published(Channel.PRESENCE)[-1] == b"0"
    start.step(ToBoard(board="ra_1", event=start.link("ra_1")))
    start.run(0.2)
    assert start.published(Channel.PRESENCE)[-1] == b"1"


def test_a_cut_link_loses_what_is_said_on_both_ways_until_somebody_ends_it(start: Start) -> None:
    number = start.begin("cut_link", seconds=60.0)
    said = len(start.telemetry())
    start.move()
    start.run(5.0)
    assert len(start.telemetry()) == said
    start.step(MishapEnds(number=number))
    start.run(0.3)
    assert len(start.telemetry()) > said
    assert start.telemetry()[-1].ack in (None, 0)
    start.step(MishapEnds(number=number))
    assert start.heard[-1] == MishapOver(number=number)
    start.run(60.0)
    assert start.notes == [("cut_link", "ra_1", False), ("cut_link", "ra_1", True)]


def test_a_slow_link_is_late_both_ways(start: Start) -> None:
    start.begin("slow_link", seconds=30.0)
    start.move()
    start.run(0.65)
    assert not start.bench.boards["ra_1"].body.moving
    start.run(0.1)
    assert start.bench.boards["ra_1"].body.moving
    assert all(each.state is MotionState.STOPPED for each in start.telemetry())
    start.run(0.8)
    assert start.telemetry()[-1].state is MotionState.MOVING


def test_a_frozen_board_does_nothing_and_takes_later_what_waits(start: Start) -> None:
    start.begin("freeze", seconds=3.0)
    said = len(start.telemetry())
    start.move()
    start.run(2.9)
    assert len(start.telemetry()) == said
    assert not start.bench.boards["ra_1"].body.moving
    start.run(0.2)
    assert start.bench.boards["ra_1"].body.moving


def test_a_frozen_board_that_loses_its_power_has_forgotten_what_waited(start: Start) -> None:
    start.begin("freeze", seconds=3.0)
    start.move()
    start.begin("reboot")
    start.run(4.0)
    assert not start.bench.boards["ra_1"].body.moving
    assert len(start.telemetry()) > 10


def test_an_effector_grips_beside_the_part_sticks_or_opens(start: Start) -> None:
    body = arm_body(start.bench, "ra_1")
    start.begin("stuck_effector", seconds=1.0)
    start.switch(on=True)
    assert not body.effector
    start.run(1.1)
    start.switch(on=True)
    assert body.effector
    start.begin("opened_effector")
    assert not body.effector
    start.begin("no_grip", seconds=1.0)
    assert not body.grips
    start.run(1.1)
    assert body.grips


def test_two_mishaps_of_one_kind_end_with_the_later_one(start: Start) -> None:
    start.begin("driver_alarm", seconds=1.0)
    start.begin("driver_alarm", seconds=3.0)
    start.run(2.0)
    assert start.telemetry()[-1].state is MotionState.FAULT
    start.run(1.5)
    assert start.telemetry()[-1].state is MotionState.STOPPED


@pytest.mark.parametrize("plant", ["shipped", "mill"])
def test_every_mishap_of_boards_begins_and_ends_at_every_target(plant: str) -> None:
    model = shipped("sis_a", "sis_c") if plant == "shipped" else loader.load(MILL)
    start, tried = Start(model), 0
    for mishap in MISHAPS.values():
        for target in set(mishap.targets(model)) & start.bench.boards.keys() if mishap.is_of_boards else ():
            start.begin(mishap.name, target, 0.5)
            tried += 1
    assert tried > 5
    start.run(20.0)
    assert not start.bench.begun
    lasting = [name for name, _, over in start.notes if not over and MISHAPS[name].lasts]
    assert sorted(lasting) == sorted(name for name, _, over in start.notes if over)
    for board in start.bench.boards:
        said = len(start.telemetry(board))
        start.run(1.0)
        assert len(start.telemetry(board)) > said
