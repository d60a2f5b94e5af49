"""A command to a PLC over the driver modbus until its end is reported, against a bare client of pymodbus.

The PLC takes an order and echoes it as done in the same moment, in a server of pymodbus in a thread of
this process. Ours is `send` of the driver until its report of done, with the thread that polls and the
mapping between; the floor writes the same registers and reads the same blocks with `ModbusTcpClient` itself.
In turns, over one server. The second row is a fact that changes by itself: there both wait for the next
poll, which comes 10 ms after the one before.
"""

from __future__ import annotations

import queue
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from arboleda.adapters.modbus import Modbus
from arboleda.adapters.modbus_server import ModbusServer
from arboleda.app.config import load
from arboleda.drivers import Report, VerbCommand
from arboleda.drivers.modbus.machine import ModbusDevice
from arboleda.drivers.modbus.settings import Settings
from arboleda.kinds.declared import Device
from arboleda.model.errors import ArboledaError

from .result import Aim, Figure, Result, percentile
from .scene import Scene

EXAMPLE = Path(__file__).parents[2] / "examples/plc_conveyor/plant.yaml"
AIM = Aim(most=1.5)
POLL_S = 0.01
PATIENCE_S = 5.0
NUMBER, ACCEPTED, DONE, SPEED = 3, 3, 4, 11


class Echo:
    """A PLC that has done everything as soon as it is asked."""

    def __init__(self) -> None:
        self.inputs = [0] * 13

    def read(self, table: str, address: int, count: int) -> list[int] | int:
        return ((self.inputs if table == "input" else []) + [0] * 256)[address : address + count]

    def write(self, table: str, address: int, values: list[int]) -> int | None:
        if table == "holding" and address <= NUMBER < address + len(values):
            self.inputs[ACCEPTED] = self.inputs[DONE] = values[NUMBER - address]
        return None


def run(scene: Scene) -> Result:
    try:
        import pymodbus  # noqa: F401
    except ImportError as error:
        raise ArboledaError("pymodbus is not installed: pip install 'arboleda[modbus]'") from error
    times = 200 if scene.quick else 2000
    scene.say("starting")
    (belt,) = load(EXAMPLE).robots.values()
    assert isinstance(belt, Device) and belt.driver is not None and isinstance(belt.driver.settings, Settings)
    memory = Echo()
    server = ModbusServer(memory)
    port = server.start()
    rest = {"alive": None, "heartbeat": None, "boot": None}
    settings = replace(belt.driver.settings, port=port, poll_s=POLL_S, **rest)
    ours, floor = Driven(belt, settings), Bare(belt, settings)
    try:
        rows = [
            ("an order until it is done", "ms", ours.order, floor.order),
            ("a changed fact until it is known", "ms", *(_changed(memory, each) for each in (ours, floor))),
        ]
        figures = []
        for name, unit, one, other in rows:
            scene.say(name)
            pairs = [(one(), other()) for _ in range(times)]
            figures += [_figure(f"{name}, p{percent}", unit, pairs, percent) for percent in (50, 99)]
    finally:
        ours.close()
        floor.close()
        server.stop()
    where = "over one server of pymodbus in this process"
    note = f"{times} of each in turns, {where}; polls {POLL_S * 1000:g} ms apart"
    return Result(figures=figures, notes=(note,))


def _figure(name: str, unit: str, pairs: list[tuple[float, float]], percent: int) -> Figure:
    ours, floor = (percentile([1000 * pair[at] for pair in pairs], percent) for at in range(2))
    return Figure(name=name, unit=unit, ours=ours, floor=floor, aim=AIM if percent == 50 else None)


def _changed(memory: Echo, client: Driven | Bare) -> Callable[[], float]:
    def once() -> float:
        memory.inputs[SPEED] = (memory.inputs[SPEED] + 1) % 60000
        began = time.perf_counter()
        client.until_speed(memory.inputs[SPEED])
        return time.perf_counter() - began

    return once


class Driven:
    """The driver, as a plant uses it."""

    def __init__(self, belt: Device, settings: Settings) -> None:
        self._belt, self._number = belt, 0
        self._said: queue.Queue[Report] = queue.Queue()
        self._driver = Modbus(settings)
        self._driver.start([belt], self._said.put, time.monotonic)
        self._until(lambda report: report.state is not None)

    def order(self) -> float:
        self._number += 1
        id = f"c{self._number}"
        command = self._belt.kind.command(id=id, robot=self._belt.name, verb="load", values={})
        assert isinstance(command, VerbCommand)
        began = time.perf_counter()
        self._driver.send(command)
        self._until(lambda report: report.done == id)
        return time.perf_counter() - began

    def until_speed(self, speed: int) -> None:
        self._until(lambda report: report.fact("mm_s") == speed)

    def close(self) -> None:
        self._driver.stop()

    def _until(self, fits: Callable[[Report], bool]) -> None:
        while not fits(self._said.get(timeout=PATIENCE_S)):
            pass


class Bare:
    """What somebody writes who has pymodbus and nothing else: write, read, look, rest."""

    def __init__(self, belt: Device, settings: Settings) -> None:
        from pymodbus.client import ModbusTcpClient

        self._client = ModbusTcpClient(settings.host, port=settings.port, timeout=PATIENCE_S)
        self._blocks = ModbusDevice(belt, settings).blocks
        self._number = 30000

    def order(self) -> float:
        self._number += 1
        began = time.perf_counter()
        self._client.write_register(0, 1)
        self._client.write_register(NUMBER, self._number)
        while self._read()["input", DONE] != self._number:
            time.sleep(POLL_S)
        return time.perf_counter() - began

    def until_speed(self, speed: int) -> None:
        """At the end of a rest that it is anywhere in."""
        time.sleep(POLL_S * (self._number % 10) / 10)
        self._number += 1
        while self._read()["input", SPEED] != speed:
            time.sleep(POLL_S)

    def close(self) -> None:
        self._client.close()

    def _read(self) -> dict[tuple[str, int], int]:
        raw: dict[tuple[str, int], int] = {}
        for block in self._blocks:
            if block.table == "discrete":
                values = self._client.read_discrete_inputs(block.address, count=block.length).bits
            else:
                values = self._client.read_input_registers(block.address, count=block.length).registers
            raw |= {(block.table, block.address + at): int(value) for at, value in enumerate(values)}
        return raw
