"""Campaign of the belt behind an S7 under faults: the driver's machine at the PLC's data blocks."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TypeVar

from arboleda.drivers import Report
from arboleda.model.commands import Command, Stop
from arboleda.model.messages import Reason
from arboleda.model.plant_model import PlantModel
from arboleda_drivers.plc.handshake import Read
from arboleda_drivers.s7.addresses import address
from arboleda_drivers.s7.machine import LEAST_PDU, S7Device, WriteRequest
from arboleda_drivers.s7.settings import Settings
from arboleda_drivers.s7.virtual.memory import FAULTS, BeltMemory

from .plc import NO_LINK, BeltRig, LineBroken
from .rig import Causes

CAUSES: Causes = {
    "mute": NO_LINK,
    "refuses_reads": NO_LINK,
    "refuses_writes": {Reason.REJECTED, *NO_LINK},
}
REFUSAL = "error_8404"
T = TypeVar("T")


class S7Rig(BeltRig):
    """Test with the example's belt, and the data blocks of its virtual PLC."""

    driver = "s7"

    def __init__(self, example: PlantModel) -> None:
        super().__init__(example, FAULTS, CAUSES)
        self._memory = BeltMemory(self.faults, lambda: self.now, belt=self.belt)
        self._late: list[Callable[[], None]] = []  # writes to a mute PLC, which it carries out afterwards

    def wire(self) -> DataBlocks:
        assert self.device.driver is not None and isinstance(self.device.driver.settings, Settings)
        settings = self.device.driver.settings
        return DataBlocks(S7Device(self.device, settings), settings, self._memory, self)

    def answer(self, late: Callable[[], None] | None = None) -> None:
        """Answer what waits, before anything new; raises LineBroken while the PLC is mute."""
        if "mute" in self.faults:
            if late is not None:
                self._late.append(late)
            raise LineBroken("the PLC does not answer")
        while self._late:
            self._late.pop(0)()


class DataBlocks:
    """Reads and writes of the driver's machine; a mute PLC carries out its writes late."""

    def __init__(self, machine: S7Device, settings: Settings, memory: BeltMemory, rig: S7Rig) -> None:
        self._machine, self._settings, self._memory, self._rig = machine, settings, memory, rig

    def begin(self) -> None:
        self._machine.begin(self._read())

    def order(self, command: Command) -> str | None:
        for put in self._machine.order(command).puts:
            try:
                self._write(put)
            except ValueError as error:
                if isinstance(command, Stop):
                    raise LineBroken(str(error)) from error
                return REFUSAL
        return None

    def beat(self, number: int) -> None:
        at = address(self._settings.heartbeat or "")
        try:
            self._write(WriteRequest(place=at, raw=at.raw(number % (at.greatest + 1))))
        except ValueError as error:
            raise LineBroken(str(error)) from error

    def report(self, at: float) -> Report:
        return self._machine.report(at, self._read())

    def _read(self) -> Read:
        self._rig.answer()
        raw = {}
        for block in self._machine.blocks(LEAST_PDU):
            held = self._refusable(partial(self._memory.read, block.db))
            raw[block] = held.ljust(256, b"\0")[block.byte : block.byte + block.length]
        return self._machine.values(raw)

    def _write(self, put: WriteRequest) -> None:
        write = partial(self._memory.write, put.place.db, put.place.byte, put.raw)
        self._rig.answer(write)
        write()

    def _refusable(self, read: Callable[[], T]) -> T:
        try:
            return read()
        except ValueError as error:
            raise LineBroken(str(error)) from error
