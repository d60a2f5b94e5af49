"""Data blocks of the belt: the addresses of its program's numbers, and the faults of the connection.

DB1 is what the program shows, in the order in which a driver reads it; DB2 is what it is told.
"""

from __future__ import annotations

import struct
import threading
from collections.abc import Callable, Collection

from arboleda_drivers.plc.virtual.machine import FAULTS as BELT_FAULTS
from arboleda_drivers.plc.virtual.machine import Belt

FAULTS = {
    "mute": "requests are not answered, and connections stay",
    "refuses_reads": "nothing can be read: return code 1, hardware fault",
    "refuses_writes": "nothing can be written: error 8404",
    **BELT_FAULTS,
}
SHOWS, ORDERS = 1, 2  # the numbers of the data blocks
SHOWN = struct.Struct(">10H?Bh")  # ten words, the bit of the gate, the eye, the speed
WORDS = ("done", "rejected", "failed", "accepted", "reason", "failure", "boot", "alive", "state", "part_at")
ORDER = struct.Struct(">BxhiHH??")  # verb, to, mm/s, number, heartbeat, halt, latch
NUMBER, BEAT, HALT, LATCH = 8, 10, 12, 13  # the first bytes of these
MEANINGLESS = 77


class BeltMemory:
    """Data blocks that an S7 server serves; each access also moves the program on to the present time."""

    def __init__(
        self, faults: Collection[str], clock: Callable[[], float], *, belt: Belt | None = None
    ) -> None:
        self._faults, self._clock = faults, clock
        self._belt = belt or Belt(faults=faults)
        self._order = bytearray(ORDER.size)
        self._lock = threading.Lock()

    def read(self, db: int) -> bytes:
        """All bytes of a data block; raises ValueError where the PLC refuses to show them."""
        if "refuses_reads" in self._faults:
            raise ValueError("nothing can be read")
        with self._lock:
            self._belt.scan(self._clock())
            return self._shown() if db == SHOWS else bytes(self._order)

    def write(self, db: int, byte: int, data: bytes) -> None:
        """Take bytes of a data block; raises ValueError where the PLC refuses them."""
        if "refuses_writes" in self._faults or db != ORDERS or byte + len(data) > ORDER.size:
            raise ValueError("nothing can be written")
        with self._lock:
            self._take(byte, data)

    def _shown(self) -> bytes:
        shown = self._belt.shown
        words = [getattr(shown, name) for name in WORDS]
        if "nonsense" in self._faults:
            words[WORDS.index("part_at")] = MEANINGLESS
        return SHOWN.pack(*words, bool(shown.gate), shown.seen, shown.mm_s)

    def _take(self, byte: int, data: bytes) -> None:
        """Take bytes; a changed number is a new order, the same one again is none."""
        now, before = self._clock(), self._number()
        self._order[byte : byte + len(data)] = data
        verb, to, speed, number, beat, halts, latched = ORDER.unpack(self._order)
        written = range(byte, byte + len(data))
        if BEAT in written:
            self._belt.beat(now, beat)
        if HALT in written and halts:
            self._belt.halt(now)
        if LATCH in written:
            self._belt.latch(now, on=latched)
        if number != before:
            self._belt.order(now, number, verb, to, speed)

    def _number(self) -> int:
        return int.from_bytes(self._order[NUMBER:BEAT], "big")
