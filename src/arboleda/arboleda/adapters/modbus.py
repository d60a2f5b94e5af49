"""The driver `modbus`: PLCs over Modbus TCP and RTU, by pymodbus."""

from __future__ import annotations

import logging
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from arboleda.drivers import Clock, Command, Hear, NotSent, Report, Robot, driver, lost
from arboleda.drivers.modbus.machine import Block, ModbusDevice, Raw, WriteRequest
from arboleda.drivers.modbus.settings import Settings
from arboleda.drivers.plc.plc_snapshot import UnreadableValue
from arboleda.drivers.port import DriverError

if TYPE_CHECKING:
    from pymodbus.client.base import ModbusBaseSyncClient

MISSING = "pymodbus and pyserial are not installed, which it needs: pip install 'arboleda[modbus]'"
BEAT_S = 0.2  # period of reports without a change
AGAIN_S = 0.5
JOIN_S = 2.0
BEATS = 2**16
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


class RequestRefused(DriverError):
    """Error: a PLC has answered a request with an exception code."""

    def __init__(self, what: str, code: int) -> None:
        self.word = WORDS.get(code, f"code_{code}")
        super().__init__(f"the PLC refuses {what}: {self.word} (exception code {code})")


class Line:
    """Connection that the devices on it use in turns."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._lock = threading.RLock()
        self._client: ModbusBaseSyncClient | None = None

    @contextmanager
    def turn(self) -> Iterator[None]:
        """Context with the line to oneself; an error ends the connection, and so drops a late answer."""
        try:
            with self._lock:
                yield
        except (RequestRefused, UnreadableValue):
            raise
        except Exception:  # after any error: an answer may still be on its way
            self.close()
            raise

    def open(self) -> None:
        """Connect, unless connected; raises ConnectionError if nobody answers."""
        if self._client is None:
            self._client = _client(self._settings)
        if not self._client.connect():
            raise ConnectionError(f"{self._settings.peer} is not there")

    def close(self) -> None:
        with self._lock:
            if self._client is not None:
                self._client.close()

    def read(self, unit: int, block: Block) -> list[int]:
        """The values of a block."""
        self.open()
        read: Any = getattr(self._client, READS[block.table])
        answer = read(block.address, count=block.length, device_id=unit)
        _check(answer, f"to show {block.table} {block.address}", CODES[block.table])
        values = answer.bits if block.table in ("coil", "discrete") else answer.registers
        whole = -(-block.length // 8) * 8 if block.table in ("coil", "discrete") else block.length
        if len(values) != whole:
            raise ConnectionError(
                f"{self._settings.peer} has answered with {len(values)} values, not {whole}"
            )
        return [int(value) for value in values[: block.length]]

    def write(self, unit: int, put: WriteRequest) -> None:
        """Write the values of a put."""
        self.open()
        client: Any = self._client
        values: list[Any] = list(put.values)
        if put.table == "coil":
            values = [bool(value) for value in values]
        one, many = (
            (client.write_coil, client.write_coils)
            if put.table == "coil"
            else (client.write_register, client.write_registers)
        )
        answer = (
            one(put.address, values[0], device_id=unit)
            if len(values) == 1
            else many(put.address, values, device_id=unit)
        )
        code = WRITES[put.table, len(values) == 1]
        _check(answer, f"to take {put.table} {put.address}", code)
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


class Lines:
    """Lines in use: devices of the same PLC, or on the same serial line, share one."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._lines: dict[tuple[object, ...], tuple[Line, int]] = {}

    def take(self, settings: Settings) -> Line:
        with self._lock:
            line, users = self._lines.get(_address(settings), (None, 0))
            line = line or Line(settings)
            self._lines[_address(settings)] = (line, users + 1)
            return line

    def give_back(self, settings: Settings) -> None:
        """Give a line back; the last user closes it."""
        with self._lock:
            line, users = self._lines.pop(_address(settings))
            if users > 1:
                self._lines[_address(settings)] = (line, users - 1)
                return
        line.close()


LINES = Lines()


@driver("modbus", settings=Settings)
class Modbus:
    """Driver of one device: a thread polls it, commands leave in `send`."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._ending, self._wake = threading.Event(), threading.Event()
        self._line: Line | None = None
        self._poller: threading.Thread | None = None
        self._up = False
        self._beats = 0
        self._said: tuple[float, Report] | None = None

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        if len(devices) != 1:
            raise DriverError("a mapping is for one device")
        need_library()
        self._name, self._hear, self._clock = devices[0].name, hear, clock
        self._device = ModbusDevice(devices[0], self._settings)
        self._line = LINES.take(self._settings)
        self._poller = threading.Thread(target=self._poll, name=f"modbus {self._name}", daemon=True)
        self._poller.start()

    def listen(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        """The same without a heartbeat: to the PLC nobody is there."""
        self._settings = replace(self._settings, heartbeat=None)
        self.start(devices, hear, clock)

    def send(self, command: Command) -> None:
        line = self._line
        if line is None or not self._up:
            raise NotSent(f"{self._settings.peer} is not connected")
        with line.turn():
            try:
                for put in self._device.order(command):
                    line.write(self._settings.unit, put)
            except RequestRefused as error:
                self._refuse(command, error)
        self._wake.set()

    def stop(self) -> None:
        self._ending.set()
        self._wake.set()
        if self._poller is not None:
            self._poller.join(JOIN_S + self._settings.timeout_s)
        if self._line is not None:
            LINES.give_back(self._settings)
            self._line = None

    def _refuse(self, command: Command, error: RequestRefused) -> None:
        """Report a refusal with the present time: with the command's it would be older than a poll."""
        if command.id:
            self._hear(Report(at=self._clock(), robot=self._name, rejected=command.id, refusal=error.word))

    def _poll(self) -> None:
        assert self._line is not None
        while not self._ending.is_set():
            try:
                self._serve(self._line)
            except Exception as error:  # noqa: BLE001 - pymodbus raises its own and others; all mean: no link
                self._up, self._said = False, None
                self._hear(lost(self._name, at=self._clock(), why=_why(self._settings, error)))
            self._ending.wait(AGAIN_S)

    def _serve(self, line: Line) -> None:
        """Report the values of the PLC until the end, or until something breaks."""
        with line.turn():
            self._device.begin(self._read(line, self._device.first_blocks))
            self._up = True
        while not self._ending.is_set():
            self._wake.clear()
            with line.turn():
                at = self._clock()
                said = self._device.report(at, self._read(line, self._device.blocks))
                self._beat(line)
            self._say(said)
            self._wake.wait(self._settings.poll_s)

    def _read(self, line: Line, blocks: Sequence[Block]) -> Raw:
        raw: dict[tuple[str, int], int] = {}
        for block in blocks:
            values = line.read(self._settings.unit, block)
            raw |= {(block.table, block.address + at): value for at, value in enumerate(values)}
        return raw

    def _beat(self, line: Line) -> None:
        """Write the heartbeat to the PLC, which has to stop by itself once it ends."""
        place = self._settings.heartbeat
        if place is not None:
            self._beats = (self._beats + 1) % BEATS
            value = self._beats % 2 if place.table == "coil" else self._beats
            line.write(
                self._settings.unit, WriteRequest(table=place.table, address=place.address, values=(value,))
            )

    def _say(self, report: Report) -> None:
        """Hand over a report if it is news, and otherwise from time to time."""
        if self._said is not None:
            at, before = self._said
            if report.again(before.at) == before and report.at - at < BEAT_S:
                return
        self._said = (report.at, report)
        self._hear(report)


def _address(settings: Settings) -> tuple[object, ...]:
    if settings.serial:
        return (settings.serial,)
    return (settings.host, settings.port, settings.timeout_s)


def _client(settings: Settings) -> ModbusBaseSyncClient:
    from pymodbus.client import ModbusSerialClient, ModbusTcpClient

    once = {"timeout": settings.timeout_s, "retries": 0}  # a write that is repeated is a command given twice
    if not settings.serial:
        return ModbusTcpClient(settings.host, port=settings.port, **once)
    parity = PARITIES[settings.parity]
    return ModbusSerialClient(
        settings.serial, baudrate=settings.baud, parity=parity, stopbits=2 if parity == "N" else 1, **once
    )


def _check(answer: Any, what: str, code: int) -> None:
    """Raises RequestRefused for an exception code, ConnectionError for the answer to another request.

    pymodbus takes such an answer as well.
    """
    if answer.function_code & 0x7F != code:
        raise ConnectionError(
            f"the PLC was asked {what}, and has answered with function {answer.function_code}"
        )
    if answer.isError():
        raise RequestRefused(what, answer.exception_code)


def need_library() -> None:
    """Raises DriverError with install advice if pymodbus is missing; otherwise silences its log."""
    try:
        import pymodbus
        import serial
    except ImportError as error:
        raise DriverError(MISSING) from error
    assert pymodbus.__name__ and serial.__name__
    logging.getLogger("pymodbus.logging").setLevel(logging.CRITICAL)  # the plant reports the same


def _why(settings: Settings, error: Exception) -> str:
    if isinstance(error, DriverError | ConnectionError):
        return str(error)
    return f"{settings.peer}: {error or type(error).__name__}"
