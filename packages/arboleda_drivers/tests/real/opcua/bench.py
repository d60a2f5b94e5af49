"""The press behind OPC UA: variables that a test sets by hand, on asyncua's server."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from arboleda.testing.drivers.bench import HALT, LATCH
from arboleda_drivers.opcua.server import OpcUaServer

from ..contract.press import Order, Words
from ..plc.bench import PlayedPlc, bench, numbers

DRIVER = """
          opcua:
            url: opc.tcp://127.0.0.1:%d
            security: none
            boot: ns=2;s=boot
            state: {node: ns=2;s=state}
            sequence:
              accepted: ns=2;s=accepted
              done: ns=2;s=done
              rejected: ns=2;s=rejected
              reason: {node: ns=2;s=reason, words: {ocupado: 1}}
              failed: ns=2;s=failed
              failure: {node: ns=2;s=failure, words: {atasco: 1}}
            facts: {guard: {node: ns=2;s=guard}, strokes: {node: ns=2;s=strokes}}
            verbs:
              open: {call: ns=2;s=Open, on: ns=2;s=Device}
              close: {call: ns=2;s=Close, on: ns=2;s=Device}
              press: {call: ns=2;s=Press, on: ns=2;s=Device, given: [{value: $strokes, type: uint16}]}
              measure: {call: ns=2;s=Measure, on: ns=2;s=Device, answer: {node: ns=2;s=seen}}
            halt: {call: ns=2;s=Halt, on: ns=2;s=Device}
            latch: {call: ns=2;s=Latch, on: ns=2;s=Device}
            clear: {call: ns=2;s=Clear, on: ns=2;s=Device}"""
STOPS = {"Halt": HALT, "Latch": LATCH, "Clear": "clear"}
TEXTS = dict.fromkeys(("state", "guard", "seen"), "string")
NUMBERS = ("strokes", "boot", "reason", "failure", "accepted", "rejected", "failed", "done")


@cache
def _folder() -> TemporaryDirectory[str]:
    """Folder with the nodes that every server has, until the tests are over."""
    return TemporaryDirectory()


class PlayedOpcUa(PlayedPlc):
    """Its variables and methods."""

    variables: Mapping[str, str] = TEXTS | dict.fromkeys(NUMBERS, "uint16")
    methods: Mapping[str, Sequence[str]] = {
        **dict.fromkeys(("Open", "Close", "Measure"), ("uint16",)),
        "Press": ("uint16", "uint16"),
        **dict.fromkeys(STOPS, ()),
    }

    def _serve(self, port: int) -> OpcUaServer:
        return OpcUaServer(self, port=port, kept=Path(_folder().name) / "nodes")

    def show(self) -> Mapping[str, object]:
        return self._shown

    def call(self, method: str, given: Sequence[object]) -> str | None:
        self.told(Order(ref=given[-1] if given else None, word=STOPS.get(method, method.lower())))
        return None

    def beat(self, value: object) -> None:
        """Nobody watches over this press."""

    def is_mute(self) -> bool:
        return self._silent.is_set()

    def say(self, words: Words) -> None:
        seen = words.answered[1] if words.answered is not None else "good"
        texts: dict[str, object] = {"state": words.state, "guard": words.guard, "seen": seen}
        self._shown: Mapping[str, object] = {**numbers(words), **texts}


BENCH = bench(PlayedOpcUa, DRIVER, takes="arboleda_drivers.opcua.machine.OpcUaDevice.report")
