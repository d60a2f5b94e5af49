"""A command to a PLC over the driver modbus until its end is reported, against a bare client of pymodbus.

The PLC takes an order and echoes it as done in the same moment, in a server of pymodbus in a thread of
this process. Ours is `send` of the driver until its report of done, with the thread that polls and the
mapping between; the floor writes the same registers and reads the same blocks with `ModbusTcpClient` itself.
In turns, over one server. The second row is a fact that changes by itself: there both wait for the next
poll, which comes 10 ms after the one before.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from arboleda.extension import ArboledaError
from arboleda.kinds.declared import Device
from arboleda.plant_file.loader import load
from arboleda_drivers.modbus.adapter import Modbus
from arboleda_drivers.modbus.machine import ModbusDevice
from arboleda_drivers.modbus.server import ModbusServer
from arboleda_drivers.modbus.settings import Settings

from .plc_driver import PATIENCE_S, Driven, figures
from .result import Result
from .scene import Scene

EXAMPLE = Path(__file__).parents[3] / "examples/plc_conveyor/plant.yaml"
POLL_S = 0.01
NUMBER, ACCEPTED, DONE, SPEED = 3, 3, 4, 11


class Echo:
    """A PLC that has done each order as soon as it gets it."""

    def __init__(self) -> None:
        self.inputs = [0] * 13

    def read(self, table: str, address: int, count: int) -> list[int] | int:
        return ((self.inputs if table == "input" else []) + [0] * 256)[address : address + count]

    def write(self, table: str, address: int, values: list[int]) -> int | None:
        if table == "holding" and address <= NUMBER < address + len(values):
            self.inputs[ACCEPTED] = self.inputs[DONE] = values[NUMBER - address]
        return None

    def change(self) -> int:
        """Set another speed, and return it."""
        self.inputs[SPEED] = (self.inputs[SPEED] + 1) % 60000
        return self.inputs[SPEED]


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
    given = belt.driver.settings
    settings = replace(given, port=port, poll_s=POLL_S, alive=None, heartbeat=None, boot=None)
    ours, floor = Driven(belt, Modbus(settings)), Bare(belt, settings)
    try:
        found = figures(scene, times, (ours, floor), memory.change)
    finally:
        ours.close()
        floor.close()
        server.stop()
    where = "over one server of pymodbus in this process"
    note = f"{times} of each in turns, {where}; polls {POLL_S * 1000:g} ms apart"
    return Result(figures=found, notes=(note,))


class Bare:
    """Bare client: the code that one writes with pymodbus alone: write, read, compare, pause."""

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
        """Wait until this speed is read, from another place of the pause between polls each time."""
        time.sleep(POLL_S * (self._number % 10) / 10)
        self._number += 1
        while self._read()["input", SPEED] != speed:
            time.sleep(POLL_S)

    def close(self) -> None:
        self._client.close()

    def _read(self) -> dict[tuple[str, int], int]:
        raw: dict[tuple[str, int], int] = {}
        for block in self._blocks:
            values: Sequence[bool | int]
            if block.table == "discrete":
                values = self._client.read_discrete_inputs(block.address, count=block.length).bits
            else:
                values = self._client.read_input_registers(block.address, count=block.length).registers
            raw |= {(block.table, block.address + at): int(value) for at, value in enumerate(values)}
        return raw
