"""The press behind Modbus TCP: registers that a test sets by hand, on pymodbus' server."""

from __future__ import annotations

from arboleda.testing.drivers.bench import HALT, LATCH
from arboleda_drivers.modbus.server import ModbusServer

from ..contract.press import Order, Words
from ..plc.bench import VERBS, PlayedPlc, bench, numbers

DRIVER = """
          modbus:
            host: 127.0.0.1
            port: %d
            timeout_s: 2.0
            boot: {input: 0}
            state: {input: 1, words: {stopped: 0, moving: 1, latched: 2}}
            sequence:
              write: {holding: 2}
              accepted: {input: 2}
              done: {input: 3}
              rejected: {input: 4}
              reason: {input: 5, words: {ocupado: 1}}
              failed: {input: 6}
              failure: {input: 7, words: {atasco: 1}}
            facts: {guard: {discrete: 0, words: {open: 0, closed: 1}}, strokes: {input: 8}}
            verbs:
              open: {write: [{holding: 0, value: 1}]}
              close: {write: [{holding: 0, value: 2}]}
              press: {write: [{holding: 0, value: 3}, {holding: 1, value: $strokes}]}
              measure: {write: [{holding: 0, value: 4}], answer: {input: 9, words: {good: 1, bad: 2}}}
            halt: [{coil: 0, value: true}]
            latch: [{coil: 1, value: true}]
            clear: [{coil: 1, value: false}]"""
INPUTS = ("boot", "state", "accepted", "done", "rejected", "reason", "failed", "failure", "strokes", "seen")


class PlayedModbus(PlayedPlc):
    """Its registers."""

    def __init__(self) -> None:
        self._holding = [0, 0, 0]
        super().__init__()

    def _serve(self, port: int) -> ModbusServer:
        return ModbusServer(self, port=port, trace=self._pass)

    def read(self, table: str, address: int, count: int) -> list[int] | int:
        with self._changed:
            held = self._inputs if table == "input" else [self._guard]
            return (held + [0] * 16)[address : address + count]

    def write(self, table: str, address: int, values: list[int]) -> int | None:
        if table == "coil":
            word = {(0, 1): HALT, (1, 1): LATCH, (1, 0): "clear"}[address, values[0]]
            self.told(Order(ref=None, word=word))
            return None
        self._holding[address : address + len(values)] = values
        if address + len(values) == 3:
            self.told(Order(ref=self._holding[2], word=VERBS[self._holding[0]]))
        return None

    def say(self, words: Words) -> None:
        shown = numbers(words)
        with self._changed:
            self._inputs, self._guard = [shown[name] for name in INPUTS], shown["guard"]

    def _pass(self, sent: bool, packet: bytes) -> bytes:
        return b"" if sent and self._silent.is_set() else packet


BENCH = bench(PlayedModbus, DRIVER, takes="arboleda_drivers.modbus.machine.ModbusDevice.report")
