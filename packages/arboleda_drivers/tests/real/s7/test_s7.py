"""The driver s7 against python-snap7's server, and against that of the original Snap7, in C."""

from __future__ import annotations

import os
import queue
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import replace
from pathlib import Path
from typing import IO

import pytest

from arboleda.drivers import Stop, StopMode
from arboleda.kinds.declared import Device
from arboleda_drivers.s7.adapter import S7
from arboleda_drivers.s7.keys import Verb, Write
from arboleda_drivers.s7.server import S7Server

from ..plc.driven import LONGEST_S, belt_of, driven, is_heard, is_lost, mapping, order
from ..plc.pulled import pulled, sent_over_a_pulled_cable

pytestmark = [pytest.mark.system, pytest.mark.requires("snap7")]

ORIGINAL = Path(sys.prefix, "snap7")
PEER = Path(__file__).with_name("s7_snap7_peer.py")
PART_AT = 18


class Memory:
    """A PLC that does nothing; `refuses` is the first byte of DB2 that is not taken."""

    def __init__(self) -> None:
        self.shown = bytearray(64)
        self.written: queue.Queue[tuple[int, bytes]] = queue.Queue()
        self.refuses: int | None = None
        self.shows = True

    def read(self, db: int) -> bytes:
        if not self.shows:
            raise ValueError("nothing can be read")
        return bytes(self.shown) if db == 1 else b""

    def write(self, db: int, byte: int, data: bytes) -> None:
        if byte == self.refuses:
            raise ValueError("nothing can be written")
        self.written.put((byte, data))


@pytest.fixture(scope="module")
def belt() -> Device:
    return belt_of("s7.yaml")


@contextmanager
def served(memory: Memory) -> Iterator[int]:
    server = S7Server(memory)
    try:
        yield server.start()
    finally:
        server.stop()


def test_values_leave_before_their_number_and_a_bit_by_itself(belt: Device) -> None:
    memory = Memory()
    with served(memory) as port, driven(S7(mapping(belt, port=port)), belt) as (driver, heard):
        heard.until(is_heard)
        driver.send(order(belt, "advance", to="exit", speed_mm_s=400))
        driver.send(Stop(id="c2", robot="belt", mode=StopMode.HALT))
        written = [memory.written.get(timeout=LONGEST_S) for _ in range(5)]
    assert written == [(0, b"\2"), (2, b"\0\2"), (4, b"\0\0\1\x90"), (8, b"\0\1"), (12, b"\1")]


def test_a_refused_write_rejects_the_command(belt: Device) -> None:
    memory = Memory()
    with served(memory) as port, driven(S7(mapping(belt, port=port)), belt) as (driver, heard):
        heard.until(is_heard)
        memory.refuses = 0
        driver.send(order(belt))
        report = heard.until(lambda report: report.rejected is not None)
        assert (report.rejected, report.refusal) == ("c1", "error_8404")
        heard.until(is_heard)  # the link stays
        assert memory.written.empty(), "its number never leaves"


def test_a_refused_stop_loses_the_link(belt: Device) -> None:
    memory = Memory()
    with served(memory) as port, driven(S7(mapping(belt, port=port)), belt) as (driver, heard):
        heard.until(is_heard)
        memory.refuses = 12
        with pytest.raises(ConnectionError, match=r"the PLC refuses to take DB2.DBX12.0.*; it was a stop"):
            driver.send(Stop(id="c1", robot="belt", mode=StopMode.HALT))


def test_a_refused_write_behind_one_that_was_taken_loses_the_link(belt: Device) -> None:
    memory = Memory()
    begins_twice = Verb(write=(Write(at="DB2.DBB0", value=1), Write(at="DB2.DBW2:INT", value=1)))
    unnumbered = mapping(belt, sequence=None, verbs={"load": begins_twice})
    with served(memory) as port, driven(S7(replace(unnumbered, port=port)), belt) as (driver, heard):
        heard.until(is_heard)
        memory.refuses = 2
        with pytest.raises(ConnectionError, match="what was written before may have begun"):
            driver.send(order(belt))


def test_what_was_sent_over_a_pulled_cable_does_not_arrive_once_that_is_back(belt: Device) -> None:
    memory = Memory()
    with served(memory) as port, pulled(port) as cable:
        settings = mapping(belt, port=cable.port, timeout_s=0.3)
        with driven(S7(settings), belt) as (driver, heard):
            sent_over_a_pulled_cable(cable, driver, heard, order(belt))
            assert memory.written.empty()


def test_what_has_no_meaning_or_is_refused_loses_the_link_and_says_why(belt: Device) -> None:
    memory = Memory()
    with served(memory) as port, driven(S7(mapping(belt, port=port)), belt) as (_, heard):
        heard.until(is_heard)
        memory.shown[PART_AT + 1] = 77
        assert "DB1.DBW18 is 77, for which there is no word" in str(heard.until(is_lost).lost)
        memory.shown[PART_AT + 1] = 0
        heard.until(is_heard)
        memory.shows = False
        lost = str(heard.until(is_lost).lost)
        assert "the PLC refuses to show DB1 from byte 0 on" in lost
        assert "hardware_fault (return code 0x01); is PUT/GET permitted" in lost


@pytest.fixture
def peer() -> Iterator[tuple[int, IO[str], IO[str]]]:
    """The port, input and output of the original Snap7."""
    if not ORIGINAL.is_dir():
        pytest.skip("snap7 in C is not installed; make test-tools does it")
    process = subprocess.Popen(
        [sys.executable, PEER],
        env=os.environ | {"PYTHONPATH": str(ORIGINAL)},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdin is not None and process.stdout is not None
    with closing(process.stdout):
        yield int(process.stdout.readline()), process.stdin, process.stdout
        process.stdin.close()
        process.wait()


def test_the_original_snap7_takes_orders_and_keeps_the_neighbours_of_a_bit(
    belt: Device, peer: tuple[int, IO[str], IO[str]]
) -> None:
    port, asks, says = peer
    with driven(S7(mapping(belt, port=port)), belt) as (driver, heard):
        heard.until(is_heard)
        driver.send(order(belt))
        done = heard.until(lambda report: report.done == "c1")
        assert dict(done.facts)["part_at"] == "entry"
        driver.send(order(belt, "gate", "c2", to="open"))
        rejected = heard.until(lambda report: report.rejected == "c2")
        assert rejected.refusal == "unknown"
        driver.send(Stop(id="c3", robot="belt", mode=StopMode.HALT))
        asks.write("\n")
        asks.flush()
        orders = bytes.fromhex(says.readline())
    assert orders[:4] == b"\3\0\0\1"
    assert orders[12] == 0b1010_0001, "a bit was written, and not its byte"


def test_the_original_snap7_refuses_what_is_not_there(
    belt: Device, peer: tuple[int, IO[str], IO[str]]
) -> None:
    for place, word in (("DB1.DBW4000", "address_out_of_range"), ("DB7.DBW0", "no_such_block")):
        with driven(S7(mapping(belt, port=peer[0], boot=place)), belt) as (_, heard):
            assert word in str(heard.until(is_lost).lost)
