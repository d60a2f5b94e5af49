"""Virtual devices of a plant file at an MQTT broker: its own one, or one that is there."""

from __future__ import annotations

import threading
import time
from collections.abc import Collection, Iterator, Sequence
from contextlib import suppress
from queue import Empty, SimpleQueue

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.adapters.broker_login import address, login
from arboleda.adapters.mqtt import MqttClient, NotConnected
from arboleda.drivers import Device, DriverError, Robot
from arboleda.extension import Phrase, StartError, say
from arboleda.wire.transport import Connection, Delivery, Publication
from arboleda_drivers.mqtt_mapping.heard import matches
from arboleda_drivers.mqtt_mapping.settings import Settings

from .machine import VirtualMapped

TAKEN = Phrase("cli.virtual.taken", "{why} Where that is the broker, say --broker-is-there.")
LONGEST_WAIT_S = 0.1  # until a fault that was switched is noticed


class Client:
    """One device at the broker; it connects, and is cut off while the fault `vanish` is on."""

    def __init__(self, device: VirtualMapped, settings: Settings, name: str, faults: Collection[str]) -> None:
        self._device, self._settings, self._name, self._faults = device, settings, name, faults
        self._events: SimpleQueue[Delivery | Connection] = SimpleQueue()
        self._mqtt: MqttClient | None = None

    def step(self, now: float, wait_s: float) -> None:
        """Do what is due, after at most this long."""
        is_cut = "vanish" in self._faults
        if is_cut and self._mqtt is not None:
            self.close()
        elif not is_cut and self._mqtt is None:
            self._connect()
        with suppress(Empty):
            self._take(now, self._events.get(timeout=wait_s))
            while True:
                self._take(now, self._events.get_nowait())
        if now >= self._device.next_deadline:
            self._publish(self._device.step(now))

    def close(self) -> None:
        """Leave the broker, which then publishes the last will."""
        if self._mqtt is not None:
            will = self._device.will()
            self._publish([] if will is None else [will])
            self._mqtt.close()
            self._mqtt = None

    def _connect(self) -> None:
        self._mqtt = MqttClient(
            f"virtual-{self._name}",
            address(self._settings.address),
            on_event=self._events.put,
            subscriptions=self._device.topics,
            will=self._device.will(),
            credentials=login(),
            version=self._settings.version,
        )
        self._mqtt.start()

    def _take(self, now: float, event: Delivery | Connection) -> None:
        if isinstance(event, Connection):
            self._publish(self._device.begin() if event.up else [])
        elif any(matches(topic, event.topic) for topic in self._device.topics):
            self._publish(self._device.heard(now, event.topic, event.payload, event.about))

    def _publish(self, messages: Sequence[Publication]) -> None:
        for message in messages:
            with suppress(NotConnected):
                if self._mqtt is not None:
                    self._mqtt.publish(message)


class Server:
    """The devices of a plant that are mapped by topics; without a `broker` that is there it starts theirs."""

    def __init__(self, devices: Sequence[Robot], faults: Collection[str], *, is_there: bool = False) -> None:
        """Raises DriverError where none is mapped, or they are at several brokers."""
        found = [(device, settings) for device, settings in _mapped(devices)]
        brokers = {settings.address for _, settings in found}
        if len(brokers) != 1:
            names = ", ".join(sorted(brokers)) or "none"
            raise DriverError(f"the devices with driver: {{mqtt: ...}} need one broker; there are {names}")
        if not is_there and any(settings.version == "5" for _, settings in found):
            raise DriverError(
                "the broker that this starts speaks MQTT 3.1.1, and a device speaks MQTT 5; start another one"
                " there, as mosquitto, and say --broker-is-there"
            )
        (self._broker,) = brokers
        at = address(self._broker)
        self._own = None if is_there else EmbeddedBroker(at.host, at.port)
        self._clients = [
            Client(VirtualMapped(device, settings, faults), settings, device.name, faults)
            for device, settings in found
        ]
        self._names = ", ".join(device.name for device, _ in found)
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="virtual devices", daemon=True)

    @property
    def says(self) -> str:
        return f"virtual {self._names} at the broker {self._broker}"

    def start(self) -> None:
        if self._own is not None:
            try:
                self._own.start()
            except StartError as error:
                raise StartError(say(TAKEN(why=str(error)))) from error
        self._thread.start()

    def stop(self) -> None:
        self._ending.set()
        self._thread.join()
        for client in self._clients:
            client.close()
        if self._own is not None:
            self._own.stop()

    def _run(self) -> None:
        wait_s = LONGEST_WAIT_S / len(self._clients)
        while not self._ending.is_set():
            for client in self._clients:
                client.step(time.monotonic(), wait_s)


def _mapped(devices: Sequence[Robot]) -> Iterator[tuple[Device, Settings]]:
    for device in devices:
        settings = None if device.driver is None else device.driver.settings
        if isinstance(device, Device) and isinstance(settings, Settings):
            yield device, settings
