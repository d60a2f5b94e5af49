"""The board of the examples: it reads the golden messages, and does what the virtual one of its kind does."""

from __future__ import annotations

import json
from dataclasses import replace
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any

import pytest

from arboleda.model.messages import MotionState
from arboleda.plant_file.loader import load
from arboleda.sim.board import Board as VirtualBoard
from arboleda.sim.machine import MachineBody
from arboleda.wire.payloads import Telemetry, decode
from arboleda.wire.topics import Channel
from arboleda.wire.transport import Delivery

ROOT = Path(__file__).parents[4]
EXAMPLE = ROOT / "examples/own_board"
HEARD = ("orden", "paro", "latido")
BOOT = 7


def module() -> Any:
    """board.py as a module."""
    spec = spec_from_file_location("own_board", EXAMPLE / "board.py")
    assert spec is not None and spec.loader is not None
    made = module_from_spec(spec)
    spec.loader.exec_module(made)
    return made


BOARD = module()


def vectors(file: str) -> list[tuple[str, bytes]]:
    """The golden messages on the channels that a device hears: channel and bytes."""
    rows = json.loads((ROOT / "wire_vectors" / f"{file}.json").read_text("utf-8"))
    return [
        (row["channel"], bytes.fromhex(row["hex"]) if "hex" in row else row["bytes"].encode())
        for row in rows
        if row["channel"] in HEARD
    ]


@pytest.mark.parametrize("file", ["messages", "accepted"])
def test_it_reads_every_golden_message_that_it_may_be_sent(file: str) -> None:
    assert len(vectors(file)) > 2
    for channel, payload in vectors(file):
        said = BOARD.read(channel, payload)
        assert {name: said[name] for name in json.loads(payload)} == json.loads(payload)


def test_it_refuses_every_golden_message_that_is_broken() -> None:
    assert len(vectors("refused")) > 15
    for channel, payload in vectors("refused"):
        with pytest.raises(BOARD.Bad):
            BOARD.read(channel, payload)


class Both:
    """The board of the example beside the virtual one of the same device, under one time."""

    def __init__(self) -> None:
        robot = load(EXAMPLE / "plant.yaml").robots["valve"]
        self.now = 10.0
        self.virtual = VirtualBoard(robot, MachineBody(robot.kind), boot_id=BOOT, now_us=self.us)  # type: ignore[attr-defined]
        self.virtual.connect(self.us, True)
        self.said: list[bytes] = []
        self.own = BOARD.Board(self.publish, boot=BOOT, now=self.now)
        self.own.say()

    @property
    def us(self) -> int:
        return round(self.now * 1e6)

    def publish(self, channel: str, payload: bytes) -> None:
        assert channel == "sensores"
        self.said.append(payload)

    def hears(self, channel: str, retained: bool = False, **said: Any) -> None:
        payload = json.dumps(said).encode()
        topic = f"valve_1/{channel}"
        self.virtual.receive(self.us, Delivery(at=self.now, topic=topic, payload=payload, retain=retained))
        self.own.receive(channel, payload, retained=retained, now=self.now)

    def orders(self, heard: tuple[Telemetry, Telemetry], **said: Any) -> None:
        """To each of them, by who had heard this of it."""
        virtual, own = (json.dumps({**said, "visto": each.seq}).encode() for each in heard)
        self.virtual.receive(self.us, Delivery(at=self.now, topic="valve_1/orden", payload=virtual))
        self.own.receive("orden", own, retained=False, now=self.now)

    def wait(self, seconds: float) -> None:
        """Time passes, as each of them wants to be woken."""
        until = self.now + seconds
        while (due := min(self.own.due, (self.virtual.next_deadline_us or 1e18) / 1e6)) <= until:
            self.now = max(due, self.now)
            self.virtual.advance(self.us)
            self.own.pass_time(self.now)
        self.now = until

    def tell(self) -> tuple[Telemetry, Telemetry]:
        """The last message of each of them, but for its number."""
        sensors = [each for each in self.virtual.take() if each.topic.endswith("sensores")]
        self.last = sensors[-1].payload if sensors else self.last
        return words(self.last), words(self.said[-1])


def words(payload: bytes) -> Telemetry:
    said = decode(Channel.TELEMETRY, payload, axes=0)
    assert isinstance(said, Telemetry)
    return said


ORDER = {"epoca": 9}
DOSE = {"verbo": "dose", "valores": {"ml": 5}}
SCRIPT: list[tuple[str, dict[str, Any]] | float] = [
    ("orden", {"verbo": "open", "seq": 1, **ORDER}),
    0.2,
    ("orden", {"verbo": "close", "seq": 2, **ORDER}),  # ocupado
    ("orden", {"verbo": "level", "seq": 3, **ORDER}),
    0.5,
    ("orden", {"verbo": "open", "seq": 1, **ORDER}),  # a copy
    ("orden", {"verbo": "open", "seq": 2, **ORDER}),  # viejo
    ("orden", {**DOSE, "seq": 4, **ORDER}),
    1.7,
    ("orden", {"verbo": "dose", "valores": {"ml": 7}, "seq": 5, **ORDER}),  # formato
    ("orden", {"verbo": "dose", "seq": 6, **ORDER}),  # formato
    ("orden", {"verbo": "fly", "seq": 7, **ORDER}),  # formato
    ("orden", {"verbo": "open"}),  # no number
    ("orden", {"verbo": "close", "seq": 8, "retained": True, **ORDER}),
    ("orden", {"verbo": "close", "seq": 9, **ORDER}),
    0.1,
    ("paro", {"paro": 2, "seq": 10, **ORDER}),
    1.0,
    ("paro", {"paro": 1, "seq": 11, **ORDER}),
    ("orden", {"verbo": "close", "seq": 12, **ORDER}),  # paro
    ("orden", {"verbo": "level", "seq": 13, **ORDER}),
    0.5,
    ("paro", {"paro": 0, "seq": 14, **ORDER}),
    ("orden", {"verbo": "close", "seq": 15, **ORDER}),
    1.0,
    ("orden", {**DOSE, "seq": 16, **ORDER}),  # condicion
    ("latido", {"epoca": 9}),
    ("orden", {"verbo": "open", "seq": 17, **ORDER}),
    0.6,
    ("latido", {"epoca": 9}),
    ("orden", {**DOSE, "seq": 18, **ORDER}),
    0.5,
    ("paro", {"paro": 2, "seq": 3, "epoca": 8}),  # however old it is
    0.5,
    ("orden", {"verbo": "level", "seq": 1, "epoca": 10}),
    0.5,
    ("orden", {**DOSE, "seq": 19, **ORDER}),  # viejo, of an older plant
    ("orden", {**DOSE, "seq": 2, "epoca": 10}),
    0.5,
    ("orden", {"verbo": "fly", "seq": 1, "epoca": 11}),  # refused, and yet the newer one
    2.0,
    ("latido", {"epoca": 12}),
    0.2,
    ("orden", {"verbo": "level", "seq": 2, "epoca": 11}),  # viejo: another one beats
    ("latido", {"epoca": 11}),
    ("latido", {"epoca": 12 + 366 * 86_400 + 1}),  # formato: no plant can have started then
    ("orden", {"verbo": "level", "seq": 3, "epoca": 11}),  # viejo
    ("orden", {"verbo": "level", "seq": 1, "epoca": 12}),
    1.0,
]


def test_it_does_and_says_what_the_virtual_board_of_its_device_does() -> None:
    both, seen = Both(), set()
    for number, step in enumerate(SCRIPT):
        if isinstance(step, float):
            both.wait(step)
        else:
            channel, said = step
            both.hears(channel, **said)
        virtual, own = both.tell()
        assert own == virtual_as(virtual, own), (number, step)
        seen.add(own.refusal)
    assert {"viejo", "formato", "retenido", "ocupado", "paro", "condicion"} <= seen


def test_without_a_heartbeat_it_gives_its_work_up_as_the_virtual_board_does() -> None:
    both = Both()
    both.hears("latido", epoca=9)
    both.hears("orden", verbo="open", seq=1, **ORDER)
    both.wait(0.6)
    both.hears("orden", seq=2, **DOSE, **ORDER)
    both.wait(0.4)
    both.hears("latido", epoca=8)  # of a plant that is over
    both.wait(0.59)
    virtual, own = both.tell()
    assert own.state == virtual.state and own.failures is None
    both.wait(0.02)
    virtual, own = both.tell()
    assert own == virtual_as(virtual, own) and own.failures == ((2, "silencio"),)


@pytest.mark.parametrize(("waited_s", "refusal"), [(1.7, None), (2.3, "tarde")])
def test_an_order_that_waited_too_long_is_refused_as_by_the_virtual_board(
    waited_s: float, refusal: str | None
) -> None:
    both = Both()
    both.wait(3.0)
    heard = both.tell()
    both.wait(waited_s)
    both.orders(heard, verbo="open", seq=1, **ORDER)
    virtual, own = both.tell()
    assert own == virtual_as(virtual, own) and own.refusal == refusal
    assert (own.state is MotionState.MOVING) is (refusal is None)


def test_a_number_that_it_has_not_told_since_power_up_is_too_late() -> None:
    both = Both()
    both.wait(1.0)
    virtual, own = both.tell()
    both.orders((replace(virtual, seq=99), replace(own, seq=99)), verbo="open", seq=1, **ORDER)
    virtual, own = both.tell()
    assert own == virtual_as(virtual, own) and own.refusal == "tarde"


def test_what_else_is_against_a_late_order_is_said_first() -> None:
    both = Both()
    heard = both.tell()
    both.wait(2.3)
    both.orders(heard, seq=1, **DOSE, **ORDER)
    virtual, own = both.tell()
    assert own == virtual_as(virtual, own) and own.refusal == "condicion"


def virtual_as(virtual: Telemetry, own: Telemetry) -> Telemetry:
    """The message of the virtual board, with the number of the other's message."""
    return replace(virtual, seq=own.seq)
