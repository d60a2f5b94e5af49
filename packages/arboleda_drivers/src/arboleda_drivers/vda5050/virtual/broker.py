"""Virtual vehicle at an MQTT broker: its own one, or an existing one."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Collection
from contextlib import suppress
from queue import Empty, SimpleQueue
from typing import Any

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.adapters.broker_login import address, login
from arboleda.adapters.mqtt import MqttClient, NotConnected
from arboleda.wire.transport import Connection, Delivery, Publication
from arboleda_drivers.vda5050.messages import Headers, SchemaMismatch, from_bytes, to_bytes
from arboleda_drivers.vda5050.settings import MAJOR

from .machine import Connect, ConnectionCut, Message, OutgoingMessage, VehicleMessage, VirtualAgv
from .words import BROKEN

CONNECT_S = 5.0


class Server:
    """Vehicle that runs from `start` to `stop`; without a `broker` it starts one on host and port."""

    def __init__(
        self,
        faults: Collection[str] = (),
        *,
        manufacturer: str,
        serial: str,
        version: str = "2.1",
        interface: str = "uagv",
        broker: str | None = None,
        host: str = "127.0.0.1",
        port: int = 0,
        **how: Any,
    ) -> None:
        self.machine = VirtualAgv(faults, version=version, **how)
        self._version, self._manufacturer, self._serial = version, manufacturer, serial
        self._topics = f"{interface}/{MAJOR[version]}/{manufacturer}/{serial}"
        self._headers = self._new_headers()
        self._own = EmbeddedBroker(host, port) if broker is None else None
        self.broker = broker or ""
        self._client: MqttClient | None = None
        self._events: SimpleQueue[VehicleMessage] = SimpleQueue()
        self._up, self._came, self._ending = threading.Event(), threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"vehicle {serial}", daemon=True)

    @property
    def says(self) -> str:
        return f"a virtual vehicle {self._topics} ({self._version}) is at the broker {self.broker}"

    def start(self) -> None:
        if self._own is not None:
            self.broker = str(self._own.start())
        self._thread.start()

    def stop(self) -> None:
        self._ending.set()
        self._thread.join()
        if self._client is not None:
            self._publish(_connection("OFFLINE"))
            self._client.close()
        if self._own is not None:
            self._own.stop()

    def _run(self) -> None:
        began = time.monotonic()
        while not self._ending.is_set():
            messages = self.machine.step(time.monotonic() - began, self._received())
            for message in messages:
                self._do(message)
            if self._came.is_set():
                self._came.clear()
                self._publish(_connection("ONLINE"))
            wait_s = self.machine.next_deadline - (time.monotonic() - began)
            with suppress(Empty):
                self._events.put(self._events.get(timeout=max(0.001, wait_s)))

    def _received(self) -> list[VehicleMessage]:
        messages = []
        while not self._events.empty():
            messages.append(self._events.get())
        return messages

    def _do(self, message: Message) -> None:
        if isinstance(message, OutgoingMessage):
            self._publish(message)
        elif isinstance(message, Connect):
            self._headers = self._new_headers() if message.anew else self._headers
            self._connect()
        elif isinstance(message, ConnectionCut) and self._client is not None:
            self._publish(self._broken())  # its last will, which the broker sends
            self._client.close()
            self._client = None

    def _connect(self) -> None:
        topics = [f"{self._topics}/{topic}" for topic in ("order", "instantActions")]
        self._up.clear()
        self._client = MqttClient(
            f"{self._manufacturer}-{self._serial}",
            address(self.broker),
            on_event=self._hear,
            subscriptions=topics,
            will=self._publication(self._broken()),
            credentials=login(),
        )
        self._client.start()
        self._up.wait(CONNECT_S)

    def _hear(self, event: Delivery | Connection) -> None:
        if isinstance(event, Connection):
            if event.up:
                self._came.set()
                self._up.set()
            return
        topic = event.topic.rpartition("/")[2]
        try:
            self._events.put(
                VehicleMessage(topic=topic, body=from_bytes(self._version, topic, event.payload))
            )
        except SchemaMismatch:
            self._events.put(VehicleMessage(topic=topic, body=None))

    def _publish(self, say: OutgoingMessage) -> None:
        with suppress(NotConnected):  # nobody hears it, as on any wire that is cut
            if self._client is not None:
                self._client.publish(self._publication(say))

    def _publication(self, say: OutgoingMessage) -> Publication:
        message = {**self._headers(say.topic), **say.body}
        if say.as_serial is not None:
            message["serialNumber"] = say.as_serial
        payload = to_bytes(self._version, say.topic, message) if say.fits else json.dumps(message).encode()
        qos = 1 if say.topic == "connection" else 0
        return Publication(topic=f"{self._topics}/{say.topic}", payload=payload, qos=qos, retain=say.retain)

    def _broken(self) -> OutgoingMessage:
        return _connection(BROKEN[self._version])

    def _new_headers(self) -> Headers:
        return Headers(self._version, self._manufacturer, self._serial)


def _connection(word: str) -> OutgoingMessage:
    return OutgoingMessage(topic="connection", body={"connectionState": word}, retain=True)
