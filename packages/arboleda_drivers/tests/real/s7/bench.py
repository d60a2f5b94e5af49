"""The press behind an S7: data blocks that a test sets by hand, on python-snap7's server."""

from __future__ import annotations

import struct

from arboleda.testing.drivers.bench import HALT, LATCH
from arboleda_drivers.s7.server import S7Server

from ..contract.press import Order, Words
from ..plc.bench import VERBS, PlayedPlc, bench, numbers

DRIVER = """
          s7:
            host: 127.0.0.1
            port: %d
            timeout_s: 2.0
            boot: DB1.DBW12
            state: {at: DB1.DBW14, words: {stopped: 0, moving: 1, latched: 2}}
            sequence:
              write: DB2.DBW4
              done: DB1.DBW0
              rejected: DB1.DBW2
              failed: DB1.DBW4
              accepted: DB1.DBW6
              reason: {at: DB1.DBW8, words: {ocupado: 1}}
              failure: {at: DB1.DBW10, words: {atasco: 1}}
            facts: {guard: {at: DB1.DBX16.0, words: {open: 0, closed: 1}}, strokes: {at: "DB1.DBW18:INT"}}
            verbs:
              open: {write: [{at: DB2.DBB0, value: 1}]}
              close: {write: [{at: DB2.DBB0, value: 2}]}
              press: {write: [{at: DB2.DBB0, value: 3}, {at: DB2.DBW2, value: $strokes}]}
              measure: {write: [{at: DB2.DBB0, value: 4}], answer: {at: DB1.DBB17, words: {good: 1, bad: 2}}}
            halt: [{at: DB2.DBX6.0, value: true}]
            latch: [{at: DB2.DBX7.0, value: true}]
            clear: [{at: DB2.DBX7.0, value: false}]"""
STOPS = {(6, 1): HALT, (7, 1): LATCH, (7, 0): "clear"}
SHOWN = struct.Struct(">8H?Bh")
PLACES = ("done", "rejected", "failed", "accepted", "reason", "failure", "boot", "state", "guard", "seen")
NUMBER = 4


class PlayedS7(PlayedPlc):
    """Its data blocks."""

    def __init__(self) -> None:
        self._orders = bytearray(8)
        super().__init__()

    def _serve(self, port: int) -> S7Server:
        return S7Server(self, port=port)

    def read(self, db: int) -> bytes:
        self._hold()
        with self._changed:
            return self._shown if db == 1 else bytes(self._orders)

    def write(self, db: int, byte: int, data: bytes) -> None:
        self._hold()
        self._orders[byte : byte + len(data)] = data
        if byte == NUMBER:
            number = int.from_bytes(self._orders[NUMBER : NUMBER + 2], "big")
            self.told(Order(ref=number, word=VERBS[self._orders[0]]))
        elif byte > NUMBER:
            self.told(Order(ref=None, word=STOPS[byte, data[0]]))

    def say(self, words: Words) -> None:
        numbered = numbers(words)
        shown = SHOWN.pack(*(numbered[name] for name in PLACES), numbered["strokes"])
        with self._changed:
            self._shown = shown

    def _hold(self) -> None:
        if self._silent.is_set():
            self._closed.wait()


BENCH = bench(
    PlayedS7,
    DRIVER,
    takes="arboleda_drivers.s7.machine.S7Device.report",
    device_threads="_handle_client",  # python-snap7's server has one for each connection
)
