"""The press behind an S7: data blocks that a test sets by hand, on python-snap7's server."""

from __future__ import annotations

import struct
import threading
from collections.abc import Callable

from contract.bench import HALT, LATCH
from contract.press import Order, Words
from plc.bench import bench

from arboleda_drivers.s7.server import S7Server

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
VERBS = {1: "open", 2: "close", 3: "press", 4: "measure"}
STATES = {"stopped": 0, "moving": 1, "latched": 2}
ANSWERS = {"good": 1, "bad": 2}
STOPS = {(6, 1): HALT, (7, 1): LATCH, (7, 0): "clear"}
SHOWN = struct.Struct(">8H?Bh")
NUMBER = 4


class S7Wire:
    """A PLC whose program is the test."""

    def __init__(self) -> None:
        self.told: Callable[[Order], None] = lambda order: None
        self._changed = threading.Lock()
        self._orders = bytearray(8)
        self.say(Words())  # a driver that reads zeros first finds a board that has booted then
        self._silent, self._closed = threading.Event(), threading.Event()
        self._server = S7Server(self)
        self.port = self._server.start()

    def connect(self, told: Callable[[Order], None]) -> S7Wire:
        self.told = told
        return self

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
        pairs = (words.rejected, words.failed, words.answered)
        rejected, failed, answered = (pair or (0, "") for pair in pairs)
        done = answered[0] if words.answered is not None else words.done or 0
        numbers = [done, rejected[0], failed[0], words.accepted or 0, 1, 1, words.boot, STATES[words.state]]
        shown = SHOWN.pack(*numbers, words.guard == "closed", ANSWERS.get(answered[1], 1), 0)
        with self._changed:
            self._shown = shown

    def vanish(self) -> None:
        self._server.stop()

    def come_back(self) -> None:
        self._server = S7Server(self, port=self.port)
        self._server.start()

    def hush(self) -> None:
        """A PLC that is asked and does not answer."""
        self._silent.set()

    def close(self) -> None:
        self._closed.set()
        self._server.stop()

    def _hold(self) -> None:
        if self._silent.is_set():
            self._closed.wait()


BENCH = bench(S7Wire, DRIVER)
