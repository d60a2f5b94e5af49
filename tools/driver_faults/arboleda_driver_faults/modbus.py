"""Campaign of the belt behind Modbus under faults: the driver's machine at the PLC's registers."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.drivers import Report
from arboleda.model.commands import Command
from arboleda.model.messages import Reason
from arboleda.model.plant_model import PlantModel
from arboleda_drivers.modbus.adapter import refused
from arboleda_drivers.modbus.machine import Block, ModbusDevice, Raw, WriteRequest
from arboleda_drivers.modbus.settings import Settings
from arboleda_drivers.modbus.virtual.memory import FAULTS, BeltMemory
from arboleda_drivers.plc.polled import RequestRefused

from .plc import NO_LINK, BeltRig, LineBroken
from .rig import Causes

CAUSES: Causes = {
    "mute": NO_LINK,
    "noise": NO_LINK,
    "wrong_unit": NO_LINK,
    "refuses_reads": NO_LINK,
    "refuses_writes": {Reason.REJECTED, *NO_LINK},
}
FRAME = bytes([0, 1, 0, 0, 0, 5, 1, 3, 2, 0, 7])  # any answer: what the line makes of it


class ModbusRig(BeltRig):
    """Test with the example's belt, and the registers of its virtual PLC."""

    driver = "modbus"

    def __init__(self, example: PlantModel) -> None:
        super().__init__(example, FAULTS, CAUSES)
        self._memory = BeltMemory(self.faults, lambda: self.now, belt=self.belt)

    def wire(self) -> Registers:
        assert self.device.driver is not None and isinstance(self.device.driver.settings, Settings)
        return Registers(ModbusDevice(self.device, self.device.driver.settings), self._memory)


class Registers:
    """Reads and writes of the driver's machine; the answers pass over the faulty line."""

    def __init__(self, machine: ModbusDevice, memory: BeltMemory) -> None:
        self._machine, self._memory = machine, memory

    def begin(self) -> None:
        self._machine.begin(self._read(self._machine.first_blocks))

    def order(self, command: Command) -> str | None:
        try:
            for put in self._machine.order(command):
                self._write(put)
        except RequestRefused as error:
            return error.word
        return None

    def beat(self, number: int) -> None:
        try:
            self._write(WriteRequest(table="holding", address=4, values=(number,)))
        except RequestRefused as error:
            raise LineBroken(str(error)) from error

    def report(self, at: float) -> Report:
        return self._machine.report(at, self._read(self._machine.blocks))

    def _read(self, blocks: Sequence[Block]) -> Raw:
        raw: dict[tuple[str, int], int] = {}
        for block in blocks:
            values = self._memory.read(block.table, block.address, block.length)
            self._hear()
            if isinstance(values, int):
                raise LineBroken(str(refused(f"to show {block.table} {block.address}", values)))
            raw |= {(block.table, block.address + at): value for at, value in enumerate(values)}
        return raw

    def _write(self, put: WriteRequest) -> None:
        code = self._memory.write(put.table, put.address, list(put.values))
        self._hear()
        if code is not None:
            raise refused(f"to take {put.table} {put.address}", code)

    def _hear(self) -> None:
        """The answer as it arrives over the line."""
        if self._memory.trace(True, FRAME) != FRAME:
            raise LineBroken("the PLC does not answer")
