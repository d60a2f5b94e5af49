"""Registers of the belt: the addresses of its program's numbers, and the faults of the line."""

from __future__ import annotations

import random
import threading
from collections.abc import Callable, Collection

from arboleda_drivers.plc.virtual.machine import FAULTS as BELT_FAULTS
from arboleda_drivers.plc.virtual.machine import Belt

FAULTS = {
    "mute": "requests are not answered",
    "noise": "answers are bytes of no meaning",
    "wrong_unit": "answers come from another unit",
    "refuses_reads": "nothing can be read: exception code 2, illegal address",
    "refuses_writes": "nothing can be written: exception code 6, busy",
    **BELT_FAULTS,
}
INPUTS = ("boot", "alive", "state", "accepted", "done", "rejected", "reason", "failed", "failure")
PLACES = {"part_at": 10, "mm_s": 11, "seen": 12}
VERB, TO, SPEED, NUMBER, BEAT = range(5)
HALT, LATCH = range(2)
ILLEGAL_ADDRESS, DEVICE_BUSY = 2, 6
MEANINGLESS = 77
UNIT_BYTE = {True: 6, False: 0}  # index of the unit in a packet; True: TCP


class BeltMemory:
    """Registers that a Modbus server serves; each access also moves the program on to the present time."""

    def __init__(
        self,
        faults: Collection[str],
        clock: Callable[[], float],
        *,
        tcp: bool = True,
        belt: Belt | None = None,
    ) -> None:
        self._faults, self._clock, self._tcp = faults, clock, tcp
        self._belt = belt or Belt(faults=faults)
        self._holding = [0] * 5
        self._lock = threading.Lock()

    def read(self, table: str, address: int, count: int) -> list[int] | int:
        if "refuses_reads" in self._faults:
            return ILLEGAL_ADDRESS
        with self._lock:
            self._belt.scan(self._clock())
            return (self._held(table) + [0] * 256)[address : address + count]

    def write(self, table: str, address: int, values: list[int]) -> int | None:
        if "refuses_writes" in self._faults:
            return DEVICE_BUSY
        with self._lock:
            if table == "coil":
                self._switch(address, values)
            else:
                self._write(address, values)
        return None

    def trace(self, sent: bool, packet: bytes) -> bytes:
        """A packet as it arrives over the line."""
        if not sent:
            return packet
        if "mute" in self._faults:
            return b""
        if "noise" in self._faults:
            return random.randbytes(len(packet))
        if "wrong_unit" in self._faults:
            at = UNIT_BYTE[self._tcp]
            return packet[:at] + bytes([packet[at] ^ 1]) + packet[at + 1 :]
        return packet

    def _held(self, table: str) -> list[int]:
        shown = self._belt.shown
        if table == "discrete":
            return [shown.gate]
        if table == "holding":
            return self._holding
        if table == "coil":
            return []
        held = [getattr(shown, name) for name in INPUTS] + [0] * 4
        for name, at in PLACES.items():
            held[at] = (
                MEANINGLESS if name == "part_at" and "nonsense" in self._faults else getattr(shown, name)
            )
        return held

    def _switch(self, address: int, values: list[int]) -> None:
        now = self._clock()
        for at, value in enumerate(values, address):
            if at == HALT and value:
                self._belt.halt(now)
            elif at == LATCH:
                self._belt.latch(now, on=bool(value))

    def _write(self, address: int, values: list[int]) -> None:
        """Write values; a changed number is a new order, the same one again is none."""
        now, before = self._clock(), self._holding[NUMBER]
        for at, value in enumerate(values, address):
            if at < len(self._holding):
                self._holding[at] = value
        if address <= BEAT < address + len(values):
            self._belt.beat(now, self._holding[BEAT])
        if self._holding[NUMBER] != before:
            verb, to, speed, number, _ = self._holding
            self._belt.order(now, number, verb, to, speed)
