"""The press on a broker, as boards are."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from tests.patience import PATIENCE_S

from arboleda.adapters.broker_login import address
from arboleda.adapters.mqtt import MqttClient, NotConnected
from arboleda.runtime.build import App
from arboleda.testing.drivers import Bench, Device
from arboleda.wire.transport import Connection, Delivery, Publication

from .press import CODES, NAME, STOPS, Order, Press, Words, app_of


def _open(folder: Path, state: Path) -> tuple[App, Callable[[App], Device]]:
    app = app_of(folder, state, "mqtt", parts=("broker", "bridge", "orchestrator"))
    return app, lambda app: Press(partial(MqttWire, app.links()["broker"]["address"]))


class MqttWire:
    """A board on a broker, as topics.md describes it."""

    def __init__(self, broker: str, told: Callable[[Order], None]) -> None:
        self._broker, self._told, self._number = broker, told, 0
        self._client = self._connected()

    def say(self, words: Words) -> None:
        self._number += 1
        said: dict[str, Any] = {
            "estado": CODES[words.state].value,
            "seq": self._number,
            "arranque": words.boot,
        }
        said |= {"datos": {"guard": words.guard}}
        refs = [ref for ref in (words.accepted, words.done) if ref is not None]
        refs += [pair[0] for pair in (words.rejected, words.failed, words.answered) if pair is not None]
        if refs:
            said |= {"epoca_ack": refs[0][0], "ack": words.accepted[1] if words.accepted else 0}
        if words.done is not None:
            said |= {"hecho": words.done[1]}
        if words.rejected is not None:
            said |= {"rechazo_seq": words.rejected[0][1], "rechazo": words.rejected[1]}
        if words.failed is not None:
            said |= {"fallos": [[words.failed[0][1], words.failed[1]]]}
        if words.answered is not None:
            said |= {"respuesta_seq": words.answered[0][1], "respuesta": words.answered[1]}
        self._publish("sensores", json.dumps(said).encode())

    def vanish(self) -> None:
        self._publish("conexion", b"0", retain=True)  # what the broker says in its place
        self._client.close()

    def come_back(self) -> None:
        self._client = self._connected()

    def close(self) -> None:
        self._client.close()

    def _connected(self) -> MqttClient:
        up = threading.Event()

        def heard(event: Delivery | Connection) -> None:
            if isinstance(event, Delivery):
                self._read(event.topic, json.loads(event.payload))
            elif event.up:
                up.set()

        topics = [f"{NAME}/{channel}" for channel in ("orden", "paro")]
        client = MqttClient(NAME, address(self._broker), on_event=heard, subscriptions=topics)
        client.start()
        assert up.wait(PATIENCE_S)
        client.publish(Publication(topic=f"{NAME}/conexion", payload=b"1", retain=True))
        return client

    def _read(self, topic: str, said: dict[str, Any]) -> None:
        word = said["verbo"] if topic.endswith("orden") else STOPS[said["paro"]]
        self._told(Order(ref=(said["epoca"], said["seq"]), word=word))

    def _publish(self, channel: str, payload: bytes, *, retain: bool = False) -> None:
        message = Publication(topic=f"{NAME}/{channel}", payload=payload, qos=0, retain=retain)
        with suppress(NotConnected):  # nobody hears it, as on any wire that is cut
            self._client.publish(message)


BENCH = Bench(open=_open, asks=True, watches=True)
