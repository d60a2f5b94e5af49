"""The press with topics of its own, which the plant file maps."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.runtime.build import App
from arboleda.testing.drivers import Bench, Device
from arboleda.testing.drivers.bench import HALT, LATCH

from ..contract.mqtt import MqttWire
from ..contract.press import Order, Press, Words, app_of

DRIVER = """
          mqtt:
            broker: %s
            online: {hear: press/conexion, equals: 1}
            silent_after_s: 1
            boot: {hear: press/said, path: boot}
            state:
              {hear: press/said, path: state, words: {stopped: stopped, moving: moving, latched: latched}}
            facts: {guard: {hear: press/said, path: guard}, strokes: {hear: press/said, path: strokes}}
            accepted: {hear: press/said, id: accepted}
            done: {hear: press/said, id: done}
            failed: {hear: press/said, id: "failed[0]", why: "failed[1]"}
            verbs:
              open: {send: [{topic: press/orden, payload: {ref: "{id}", word: open}}]}
              close: {send: [{topic: press/orden, payload: {ref: "{id}", word: close}}]}
              press: {send: [{topic: press/orden, payload: {ref: "{id}", word: press, n: "{strokes}"}}]}
              measure:
                send: [{topic: press/orden, payload: {ref: "{id}", word: measure}}]
                answer: {hear: press/said, path: "answered[1]"}
                id: "answered[0]"
            halt: [{topic: press/paro, payload: {word: halt}}]
            latch: [{topic: press/paro, payload: {word: latch}}]
            clear: [{topic: press/paro, payload: {word: clear}}]"""


class OwnTopics(MqttWire):
    """Its words as JSON, with the ids that it was given."""

    def say(self, words: Words) -> None:
        said: dict[str, Any] = {
            "state": words.state,
            "guard": words.guard,
            "boot": words.boot,
            "strokes": "0",
        }
        said |= {"accepted": words.accepted, "done": words.done}
        said |= {"failed": words.failed or words.rejected, "answered": words.answered}
        self._publish("said", json.dumps({key: each for key, each in said.items() if each}).encode())

    def _read(self, topic: str, said: dict[str, Any]) -> None:
        self._told(
            Order(ref=said.get("ref"), word={"halt": HALT, "latch": LATCH}.get(said["word"], said["word"]))
        )


class PressAtBroker(Press):
    """The press, with the broker at which it is."""

    def __init__(self, broker: EmbeddedBroker, at: str) -> None:
        self._broker = broker
        super().__init__(partial(OwnTopics, at))

    def close(self) -> None:
        super().close()
        self._broker.stop()


def _open(folder: Path, state: Path) -> tuple[App, Callable[[App], Device]]:
    broker = EmbeddedBroker("127.0.0.1", 0)
    at = str(broker.start())
    return app_of(folder, state, DRIVER % at), lambda app: PressAtBroker(broker, at)


BENCH = Bench(open=_open, asks=True, takes="arboleda_drivers.mqtt_mapping.machine.MappedDevice.heard")
