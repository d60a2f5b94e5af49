"""The driver modbus against servers of pymodbus, and against its simulator; TCP and a serial line."""

from __future__ import annotations

import json
import os
import queue
import socket
import struct
import subprocess
import sys
import threading
import time
import tty
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from pymodbus.client import ModbusTcpClient
from pymodbus.exceptions import ModbusException
from pymodbus.framer import FramerRTU
from tests.patience import PATIENCE_S

from arboleda.drivers import MotionState
from arboleda.kinds.declared import Device
from arboleda_drivers.modbus.adapter import LINES, Line, Modbus
from arboleda_drivers.modbus.machine import Block
from arboleda_drivers.modbus.registers import Register
from arboleda_drivers.modbus.server import ModbusServer
from arboleda_drivers.modbus.settings import Settings

from ..plc.driven import belt_of, driven, is_heard, is_lost, mapping, order
from ..plc.pulled import pulled, sent_over_a_pulled_cable

pytestmark = [pytest.mark.system, pytest.mark.requires("pymodbus", "serial")]


class Memory:
    """A PLC that does nothing; `refuses` is an exception code for writes."""

    def __init__(self) -> None:
        self.inputs = [0] * 16
        self.coils: list[int] = []
        self.written: queue.Queue[tuple[str, int, list[int]]] = queue.Queue()
        self.refuses: int | None = None

    def read(self, table: str, address: int, count: int) -> list[int] | int:
        shown = {"input": self.inputs, "coil": self.coils}.get(table, [])
        return (shown + [0] * 256)[address : address + count]

    def write(self, table: str, address: int, values: list[int]) -> int | None:
        self.written.put((table, address, values))
        return self.refuses


@pytest.fixture(scope="module")
def belt() -> Device:
    return belt_of("plant.yaml")


@contextmanager
def served(memory: Memory, **where: Any) -> Iterator[int]:
    server = ModbusServer(memory, **where)
    try:
        yield server.start()
    finally:
        server.stop()


def test_an_exception_code_rejects_the_command(belt: Device) -> None:
    memory = Memory()
    with served(memory) as port, driven(Modbus(mapping(belt, port=port)), belt) as (driver, heard):
        heard.until(is_heard)
        memory.refuses = 6
        driver.send(order(belt))
        report = heard.until(lambda report: report.rejected is not None)
        assert (report.rejected, report.refusal) == ("c1", "device_busy")
        heard.until(is_heard)  # the link stays


def test_a_command_whose_answer_does_not_come_loses_the_link_and_is_not_repeated(belt: Device) -> None:
    memory, silent = Memory(), threading.Event()

    def trace(sent: bool, packet: bytes) -> bytes:
        return b"" if sent and silent.is_set() else packet

    with (
        served(memory, trace=trace) as port,
        driven(Modbus(mapping(belt, port=port, timeout_s=0.3)), belt) as (driver, heard),
    ):
        heard.until(is_heard)
        silent.set()
        with pytest.raises(Exception, match=r"No response|not connected"):
            driver.send(order(belt))
        heard.until(is_lost)
        silent.clear()
        heard.until(is_heard)
        assert memory.written.qsize() <= 1


def test_what_was_sent_over_a_pulled_cable_does_not_arrive_once_that_is_back(belt: Device) -> None:
    memory = Memory()
    with served(memory) as port, pulled(port) as cable:
        settings = mapping(belt, port=cable.port, timeout_s=0.3)
        with driven(Modbus(settings), belt) as (driver, heard):
            sent_over_a_pulled_cable(cable, driver, heard, order(belt))
            assert memory.written.empty()


def test_two_devices_of_one_plc_share_a_connection(belt: Device) -> None:
    other = replace(belt, name="other")
    with served(Memory()) as port:
        first, second = mapping(belt, port=port), mapping(belt, port=port, unit=2)
        with driven(Modbus(first), belt) as (_, heard), driven(Modbus(second), other) as (_, more):
            heard.until(is_heard)
            more.until(is_heard)
            one, two = Modbus(first), Modbus(second)
            line = LINES.take(one.address(), one.make_line)
            assert LINES.take(two.address(), two.make_line) is line
            LINES.give_back(one.address())
            LINES.give_back(two.address())


def test_a_serial_line_speaks_rtu(belt: Device) -> None:
    memory = Memory()
    with pair() as (ours, theirs), served(memory, serial=theirs):
        loads(belt, memory, mapping(belt, host="", serial=ours, parity="none"))


def test_a_gateway_speaks_rtu_over_tcp(belt: Device) -> None:
    memory, sent = Memory(), []

    def note(is_sent: bool, packet: bytes) -> bytes:
        sent.append(packet)
        return packet

    with served(memory, framing="rtu", trace=note) as port:
        loads(belt, memory, mapping(belt, port=port, unit=7, framing="rtu"))
    assert all(packet[0] == 7 for packet in sent), "the unit is the first byte of RTU"


class LateAnswers:
    """Line on which the next `left` answers are each the one of as many requests before as are owed."""

    def __init__(self, owed: int) -> None:
        self._owed = owed
        self._kept: list[bytes] = []
        self.left = 0

    def begin(self) -> None:
        self.left = 8 + self._owed

    def __call__(self, is_sent: bool, packet: bytes) -> bytes:
        if not is_sent or not self.left:
            return packet
        self.left -= 1
        self._kept.append(packet)
        return self._kept.pop(0) if len(self._kept) > self._owed else b""


OWED = pytest.mark.parametrize("owed", [1, 2, 3, 4])


@OWED
def test_a_late_answer_is_not_taken_for_that_of_another_request(belt: Device, owed: int) -> None:
    memory, late = Memory(), LateAnswers(owed)
    memory.inputs = [0] * 40
    memory.inputs[20], memory.inputs[30] = 1, 2  # a part at the entry; 2 mm/s
    facts = {
        **belt.driver.settings.facts,
        "part_at": Register(input=20, words={"none": 0, "entry": 1, "exit": 2}),
    }
    facts["mm_s"] = Register(input=30)
    with served(memory, framing="rtu", trace=late) as port:
        at = mapping(belt, port=port, framing="rtu", timeout_s=0.2, facts=facts)
        with driven(Modbus(at), belt) as (_, heard):
            heard.until(is_heard)
            late.begin()
            lost = heard.until(is_lost)
            assert "No response" in str(lost.lost)
            back = heard.until(lambda report: is_heard(report) and not late.left)
            assert (dict(back.facts or ())["part_at"], dict(back.facts or ())["mm_s"]) == ("entry", 2)
            assert all(dict(each.facts or ()).get("part_at", "entry") == "entry" for each in heard.all)


@OWED
def test_a_late_bit_is_not_taken_for_another_one(belt: Device, owed: int) -> None:
    memory, late, seen = Memory(), LateAnswers(owed), list[tuple[int, int]]()
    memory.coils = [0, 1]
    late.begin()
    with served(memory, framing="rtu", trace=late) as port:
        line = Line(mapping(belt, port=port, framing="rtu", timeout_s=0.1))
        while late.left or len(seen) < 4:
            at = len(seen) % 2
            try:
                seen.append((at, *line.read(1, Block(table="coil", address=at, length=1))))
            except (ConnectionError, ModbusException):
                line.hang_up()
        line.hang_up()
    assert seen and all(at == value for at, value in seen)


class Gateway:
    """Serial gateway at TCP: it hands what comes from its slave to whoever is connected by then."""

    def __init__(self) -> None:
        self._listening = socket.create_server(("127.0.0.1", 0))
        self.port = self._listening.getsockname()[1]
        self.late_s = 0.0  # of the next answer
        self._asked: queue.Queue[bytes | None] = queue.Queue()
        self._client: socket.socket | None = None
        self._threads = [threading.Thread(target=each) for each in (self._serve, self._answer)]

    def __enter__(self) -> Gateway:
        for each in self._threads:
            each.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._listening.shutdown(socket.SHUT_RDWR)
        self._listening.close()
        self._asked.put(None)
        for each in self._threads:
            each.join()

    def _serve(self) -> None:
        with suppress(OSError):
            while True:
                self._client, _ = self._listening.accept()
                with self._client, suppress(OSError):
                    while frame := self._client.recv(8, socket.MSG_WAITALL):
                        self._asked.put(frame)

    def _answer(self) -> None:
        while (frame := self._asked.get()) is not None:
            unit, code, address, count = struct.unpack(">BBHH", frame[:6])
            late_s, self.late_s = self.late_s, 0.0
            time.sleep(late_s)
            values = b"".join(struct.pack(">H", address + at) for at in range(count))
            body = bytes([unit, code, len(values)]) + values
            client = self._client
            with suppress(OSError, AttributeError):
                client.sendall(body + FramerRTU.compute_CRC(body).to_bytes(2, "big"))


def test_an_answer_that_came_too_late_is_left_out_and_told(
    belt: Device, caplog: pytest.LogCaptureFixture
) -> None:
    facts = {"mm_s": Register(input=11)}
    with Gateway() as gateway:
        at = mapping(belt, port=gateway.port, framing="rtu", timeout_s=0.2, facts=facts)
        at = replace(at, boot=None, sequence=None, state=Register(input=3, words={"stopped": 3}), verbs={})
        with driven(Modbus(at), belt) as (_, heard):
            heard.until(is_heard)
            gateway.late_s = 0.9  # the driver is connected again by then
            heard.until(is_lost)
            heard.until(is_heard)
            heard.until(is_heard)
            assert {dict(each.facts)["mm_s"] for each in heard.all if each.facts} == {11.0}
    assert "an answer came too late and is left out (number 1)" in caplog.text


def loads(belt: Device, memory: Memory, at: Settings) -> None:
    """A load is written there, and what the PLC then shows makes it done."""
    with driven(Modbus(at), belt) as (driver, heard):
        heard.until(is_heard)
        driver.send(order(belt))
        assert memory.written.get(timeout=PATIENCE_S) == ("holding", 0, [1])
        table, address, (number,) = memory.written.get(timeout=PATIENCE_S)
        memory.inputs[10] = 1
        memory.inputs[3] = memory.inputs[4] = number
        report = heard.until(lambda report: report.done is not None)
        assert (table, address, report.done) == ("holding", 3, "c1")
        assert dict(report.facts or ())["part_at"] == "entry"


@contextmanager
def pair() -> Iterator[tuple[str, str]]:
    """Two ends of a serial line: two pseudo terminals, and threads that carry bytes between them.

    They know no parity.
    """
    ends = [os.openpty() for _ in range(2)]
    for _, slave in ends:
        tty.setraw(slave)

    def carry(source: int, drain: int) -> None:
        while data := os.read(source, 1024):
            if data == b"\x00end":
                return
            os.write(drain, data)

    threads = [threading.Thread(target=carry, args=(ends[at][0], ends[1 - at][0])) for at in range(2)]
    for thread in threads:
        thread.start()
    try:
        yield os.ttyname(ends[0][1]), os.ttyname(ends[1][1])
    finally:
        for _, slave in ends:
            os.write(slave, b"\x00end")
        for thread in threads:
            thread.join()
        for end in ends:
            for each in end:
                os.close(each)


CELLS = {"value": {"bits": 0, "uint16": 0, "uint32": 0, "float32": 0.0, "string": " "}}
CELLS |= {"action": dict.fromkeys(CELLS["value"])}
SIMULATED = {
    "setup": {
        "co size": 64,
        "di size": 64,
        "hr size": 64,
        "ir size": 64,
        "shared blocks": True,
        "type exception": False,
        "defaults": CELLS,
    },
    "invalid": [],
    "write": [[0, 63]],
    "uint16": [{"addr": [0, 63], "value": 0}],
    **{name: [] for name in ("bits", "uint32", "float32", "string", "repeat")},
}


@pytest.fixture
def simulator(tmp_path: Path, free_port: int) -> Iterator[int]:
    """The simulator that comes with pymodbus, as a process of its own: 64 registers, inputs are holdings."""
    server = {"comm": "tcp", "host": "127.0.0.1", "port": free_port, "framer": "socket"}
    setup = {"server_list": {"server": server}, "device_list": {"device": SIMULATED}}
    file = tmp_path / "setup.json"
    file.write_text(json.dumps(setup), "utf-8")
    code = "import sys; from pymodbus.server.simulator.main import main; sys.exit(main())"
    where = ["--json_file", str(file), "--http_host", "127.0.0.1", "--http_port", "0", "--log", "error"]
    process = subprocess.Popen([sys.executable, "-c", code, *where], cwd=tmp_path)
    try:
        yield free_port
    finally:
        process.kill()
        process.wait()


def moved(settings: Settings, by: int) -> Settings:
    """The same mapping with its inputs further on, where the simulator has no command of ours."""

    def on(place: Register) -> Register:
        return replace(place, input=place.address + by, discrete=None)

    sequence = settings.sequence
    assert sequence is not None and settings.state is not None and settings.boot is not None
    echoes = {name: on(getattr(sequence, name)) for name in ("accepted", "done", "rejected", "reason")}
    verbs = {
        name: replace(verb, answer=verb.answer and on(verb.answer)) for name, verb in settings.verbs.items()
    }
    return replace(
        settings,
        boot=on(settings.boot),
        state=on(settings.state),
        facts={name: on(place) for name, place in settings.facts.items() if name != "gate"}
        | {"gate": replace(settings.facts["gate"], discrete=None, input=by + 13)},
        verbs=verbs,
        sequence=replace(sequence, failed=None, failure=None, **echoes),
    )


def test_the_simulator_of_pymodbus_is_spoken_to(belt: Device, simulator: int) -> None:
    """A plain client of pymodbus is the program of the PLC: it sees the order, and sets what is shown."""
    moved_on = moved(mapping(belt, port=simulator), by=20)
    program = ModbusTcpClient("127.0.0.1", port=simulator, timeout=PATIENCE_S)
    with driven(Modbus(moved_on), belt) as (driver, heard), closing(program):
        heard.until(is_heard)
        driver.send(order(belt, "advance", to="exit", speed_mm_s=200))
        assert program.read_holding_registers(0, count=4).registers == [2, 2, 200, 1]
        program.write_registers(22, [1, 1])
        assert heard.until(lambda report: report.accepted == "c1").state is MotionState.MOVING
        program.write_register(30, 2)
        program.write_registers(22, [0, 1, 1])
        report = heard.until(lambda report: report.done == "c1")
        assert (report.state, dict(report.facts or ())["part_at"]) == (MotionState.STOPPED, "exit")
