"""The driver `modbus`: PLCs over Modbus TCP, RTU and RTU over TCP, by pymodbus."""

from __future__ import annotations

import logging
import os
import select
import time
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from arboleda.drivers import Command, DriverError, Report, Robot, Stop, driver
from arboleda_drivers.connections.abrupt import end_abruptly
from arboleda_drivers.modbus.machine import Block, ModbusDevice, Raw, WriteRequest
from arboleda_drivers.modbus.settings import Settings
from arboleda_drivers.plc import polled
from arboleda_drivers.plc.plc_snapshot import Writing

if TYPE_CHECKING:
    from pymodbus.client.base import ModbusBaseSyncClient

MISSING = "pymodbus and pyserial are not installed, which it needs: pip install 'arboleda[modbus]'"
PARITIES = {"even": "E", "odd": "O", "none": "N"}
WORDS = {
    1: "illegal_function",
    2: "illegal_address",
    3: "illegal_value",
    4: "device_failure",
    5: "acknowledged_only",
    6: "device_busy",
    8: "parity_error",
    10: "no_gateway_path",
    11: "no_gateway_answer",
}
"""The exception codes of the standard."""
READS_IN_STEP = 5  # the first one is short: an answer of one to four requests before has another length
BITS = ("coil", "discrete")  # tables of which an answer has whole bytes
QUIET_AT_MOST_S = 10.0
TOLD = (1, 10, 100, 1000, 10_000)  # how many late answers are told in the log
LOG = logging.getLogger("arboleda.drivers")


class Line(polled.Line):
    """Connection to a PLC, or a serial line.

    An answer in RTU has no number, and a gateway gives one that is late to whoever is connected by then. So
    after a request without an answer the line is listened to until it is quiet; then reads of different
    lengths show whether each answer is that of its own request. pymodbus empties serial lines alone.
    """

    def __init__(self, settings: Settings) -> None:
        super().__init__()
        self._settings = settings
        self._client: ModbusBaseSyncClient | None = None
        self._is_owed = not settings.has_numbers  # an answer may come yet, also one to an earlier start
        self._known: tuple[int, Block] | None = None  # the unit and block that were read last
        self._late = 0  # answers that nobody waited for any more

    def hang_up(self) -> None:
        self._is_owed = not self._settings.has_numbers
        if self._client is not None:
            self._client.close()

    def _ready(self, block: tuple[int, Block] | None = None) -> Any:
        """The client, connected, which owes no answer; `block`, with its unit, shows that where none was
        read yet. Raises ConnectionError if nobody answers."""
        self._connect()
        if self._is_owed:
            if (known := self._known or block) is not None:
                self._fall_in_step(*known)
            self._is_owed = False
        if self._came(0.0):
            raise ConnectionError(f"{self._settings.peer} has answered to another request")
        return self._client

    def _connect(self) -> None:
        client: Any = self._client or _client(self._settings)
        self._client = client
        if not client.connect():
            raise ConnectionError(f"{self._settings.peer} is not there")
        if not self._settings.serial:
            end_abruptly(client.socket)

    def _fall_in_step(self, unit: int, block: Block) -> None:
        """Take what comes late, and make sure that each answer is that of its request."""
        until = time.monotonic() + QUIET_AT_MOST_S
        while self._came(self._settings.timeout_s):
            if time.monotonic() > until:
                raise ConnectionError(f"{self._settings.peer} sends all the time")
        read: Any = getattr(self._client, READS[block.table])
        long = 9 if block.table in BITS else 2
        for length in (1, *(READS_IN_STEP - 1) * (long,)):
            answer = read(block.address, count=length, device_id=unit)
            if not answer.isError():
                self._values(replace(block, length=length), answer)
            elif answer.function_code & 0x7F != CODES[block.table]:
                raise ConnectionError(f"{self._settings.peer} has answered to another request")

    def _came(self, within_s: float) -> bool:
        """True where something came within this time; it is left out."""
        client: Any = self._client
        there = client.socket
        if not select.select([there], [], [], within_s)[0]:
            return False
        if not os.read(there.fileno(), 4096):
            raise ConnectionError(f"{self._settings.peer} has closed the connection")
        self._late += 1
        if self._late in TOLD:
            LOG.warning(
                "%s: an answer came too late and is left out (number %d)", self._settings.peer, self._late
            )
        return True

    def read(self, unit: int, block: Block) -> list[int]:
        """The values of a block."""
        with self.turn():
            read: Any = getattr(self._ready((unit, block)), READS[block.table])
            values = self._values(block, read(block.address, count=block.length, device_id=unit))
            self._known = (unit, block)
            return values

    def _values(self, block: Block, answer: Any) -> list[int]:
        _check(answer, f"to show {block.table} {block.address}", CODES[block.table])
        values = answer.bits if block.table in BITS else answer.registers
        whole = -(-block.length // 8) * 8 if block.table in BITS else block.length
        if len(values) != whole:
            raise ConnectionError(
                f"{self._settings.peer} has answered with {len(values)} values, not {whole}"
            )
        return [int(value) for value in values[: block.length]]

    def write(self, unit: int, put: WriteRequest) -> None:
        """Write the values of a put."""
        is_one, is_coil = len(put.values) == 1, put.table == "coil"
        values: list[Any] = [bool(value) for value in put.values] if is_coil else list(put.values)
        with self.turn():
            client = self._ready()
            one, many = (
                (client.write_coil, client.write_coils)
                if is_coil
                else (client.write_register, client.write_registers)
            )
            answer = (
                one(put.address, values[0], device_id=unit)
                if is_one
                else many(put.address, values, device_id=unit)
            )
            _check(answer, f"to take {put.table} {put.address}", WRITES[put.table, is_one])
            if answer.address != put.address:
                raise ConnectionError(f"{self._settings.peer} has answered to another write")


READS = {
    "coil": "read_coils",
    "discrete": "read_discrete_inputs",
    "holding": "read_holding_registers",
    "input": "read_input_registers",
}


CODES = {"coil": 1, "discrete": 2, "holding": 3, "input": 4}
WRITES = {("coil", True): 5, ("holding", True): 6, ("coil", False): 15, ("holding", False): 16}
"""The function codes of the standard; True: of one value."""


LINES: polled.Lines[Line] = polled.Lines()


@driver("modbus", settings=Settings)
class Modbus(polled.Polled[Settings, Line, WriteRequest]):
    """Driver of one device behind Modbus."""

    protocol = "modbus"
    lines = LINES

    def prepare(self, device: Robot) -> None:
        need_library()
        self._device = ModbusDevice(device, self._settings)

    def address(self) -> Hashable:
        settings = self._settings
        if settings.serial:
            return (settings.serial,)
        return (settings.host, settings.port, settings.timeout_s, settings.framing)

    def make_line(self) -> Line:
        return Line(self._settings)

    def begin(self, line: Line) -> None:
        for _ in self._read(line, self._device.first_blocks):
            pass
        with self._machine:
            self._device.begin(self._raw)

    def reads(self, line: Line) -> Iterator[None]:
        return self._read(line, self._device.blocks)

    def report(self, at: float) -> Report:
        return self._device.report(at, self._raw)

    def writing(self, command: Command) -> Writing[WriteRequest]:
        puts = self._device.order(command)
        begins_last = self._settings.sequence is not None and not isinstance(command, Stop)
        return Writing(puts=puts, begins_last=begins_last or len(puts) == 1)

    def write(self, line: Line, put: WriteRequest) -> None:
        line.write(self._settings.unit, put)

    def heartbeat(self, number: int) -> WriteRequest | None:
        place = self._settings.heartbeat
        if place is None:
            return None
        value = number % 2 if place.table == "coil" else number
        return WriteRequest(table=place.table, address=place.address, values=(value,))

    def _read(self, line: Line, blocks: Sequence[Block]) -> Iterator[None]:
        raw: dict[tuple[str, int], int] = {}
        for block in blocks:
            values = line.read(self._settings.unit, block)
            raw |= {(block.table, block.address + at): value for at, value in enumerate(values)}
            yield
        self._raw: Raw = raw


def _client(settings: Settings) -> ModbusBaseSyncClient:
    from pymodbus import FramerType
    from pymodbus.client import ModbusSerialClient, ModbusTcpClient

    timeout, retries = settings.timeout_s, 0  # a write that is repeated is a command given twice
    if not settings.serial:
        framer = FramerType.RTU if settings.framing == "rtu" else FramerType.SOCKET
        return ModbusTcpClient(
            settings.host, port=settings.port, framer=framer, timeout=timeout, retries=retries
        )
    parity = PARITIES[settings.parity]
    return ModbusSerialClient(
        settings.serial,
        baudrate=settings.baud,
        parity=parity,
        stopbits=2 if parity == "N" else 1,
        timeout=timeout,
        retries=retries,
    )


def refused(what: str, code: int) -> polled.RequestRefused:
    """The error of an exception code."""
    word = WORDS.get(code, f"code_{code}")
    return polled.RequestRefused(f"the PLC refuses {what}: {word} (exception code {code})", word)


def _check(answer: Any, what: str, code: int) -> None:
    """Raises RequestRefused for an exception code, ConnectionError for the answer to another request.

    pymodbus takes such an answer as well.
    """
    if answer.function_code & 0x7F != code:
        raise ConnectionError(
            f"the PLC was asked {what}, and has answered with function {answer.function_code}"
        )
    if answer.isError():
        raise refused(what, answer.exception_code)


def need_library() -> None:
    """Raises DriverError with install advice if pymodbus is missing; otherwise silences its log."""
    try:
        import pymodbus
        import serial
    except ImportError as error:
        raise DriverError(MISSING) from error
    assert pymodbus.__name__ and serial.__name__
    logging.getLogger("pymodbus.logging").setLevel(logging.CRITICAL)  # the plant reports the same
