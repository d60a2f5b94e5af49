"""The driver `vda5050`: one vehicle at an MQTT broker."""

from __future__ import annotations

import logging
import secrets
import threading
from collections.abc import Iterable, Sequence

from arboleda.adapters.broker_login import address, login
from arboleda.adapters.mqtt import MqttClient, NotConnected
from arboleda.adapters.rate_limit import RateLimit
from arboleda.drivers import Clock, Command, Hear, NotSent, Report, Robot, driver, plain, quoted
from arboleda.wire.transport import Connection, Delivery, Publication
from arboleda_drivers.connections.device_feed import taking
from arboleda_drivers.vda5050.machine import Message, Publish, Vehicle
from arboleda_drivers.vda5050.settings import Settings

from .messages import Headers, SchemaMismatch, from_bytes, to_bytes

LOG = logging.getLogger("arboleda.drivers.vda5050")
LONGEST_TOPIC = 300
HANDLERS = {"state": Vehicle.state, "connection": Vehicle.connection, "factsheet": Vehicle.factsheet}


@driver("vda5050", settings=Settings)
class Vda5050:
    """Driver of one vehicle and its devices. A client thread hears it, another repeats the known state."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._lock = threading.Lock()  # guards the machine, and the order of its messages
        self._ending = threading.Event()
        self._seldom = RateLimit()
        self._client: MqttClient | None = None
        self._ticking: threading.Thread | None = None

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        settings = self._settings
        for problem in [sentence for device in devices for _, sentence in settings.problems(device)]:
            raise ValueError(problem)
        mark = secrets.token_hex(4)
        self._hear, self._clock = hear, clock
        self._vehicle = Vehicle(devices, settings, mark=mark)
        self._headers = Headers(settings.version, settings.manufacturer, settings.serial)
        topics = (
            *(f"{settings.topics}/{topic}" for topic in ("state", "factsheet")),
            f"{settings.interface}/+/+/+/connection",
        )
        self._client = MqttClient(
            f"arboleda-{mark}",
            address(settings.broker),
            on_event=self._handle,
            subscriptions=topics,
            clock=clock,
            credentials=login(),
        )
        self._client.start()
        self._ticking = threading.Thread(target=self._tick, name=f"vda5050 {settings.serial}", daemon=True)
        self._ticking.start()

    def send(self, command: Command) -> None:
        with self._lock:
            try:
                self._do(self._vehicle.command(self._clock(), command))
            except (NotConnected, SchemaMismatch) as error:
                self._vehicle.unsent(command)
                raise NotSent(str(error)) from error

    def stop(self) -> None:
        self._ending.set()
        if self._client is not None:
            self._client.close()
        if self._ticking is not None:
            self._ticking.join()

    # --- its threads ---

    def _tick(self) -> None:
        while not self._ending.is_set():
            with self._lock:
                now = self._clock()
                with taking("a state", self._lose):
                    self._try(self._vehicle.step(now))
                wait_s = self._vehicle.next_deadline - now
            self._ending.wait(max(0.01, wait_s))

    def _handle(self, event: Delivery | Connection) -> None:
        with self._lock:
            if isinstance(event, Connection):
                self._try(self._vehicle.connected(self._clock(), up=event.up))
            elif len(event.topic) <= LONGEST_TOPIC:
                with taking(event.payload, self._lose):
                    self._read(event)

    def _read(self, delivery: Delivery) -> None:
        settings = self._settings
        whose, _, topic = delivery.topic.rpartition("/")
        if whose != settings.topics:
            _, version, maker, serial = whose.split("/")
            self._vehicle.link.neighbour(plain(f"{maker}/{serial} ({version})", 60))
            return
        if topic == "state" and delivery.retain:
            return  # a retained message is of unknown age
        try:
            body = from_bytes(settings.version, topic, delivery.payload)
            if (body["manufacturer"], body["serialNumber"]) != (settings.manufacturer, settings.serial):
                raise SchemaMismatch(
                    f"it says to be of {quoted(body['manufacturer'])} {quoted(body['serialNumber'])}"
                )
        except SchemaMismatch as error:
            self._warn(f"a message on {delivery.topic} is refused: {error}")
            if topic == "state":
                self._vehicle.link.refuse(str(error))
            return
        self._try(HANDLERS[topic](self._vehicle, self._clock(), body))

    def _lose(self, why: str) -> None:
        self._warn(f"{self._settings.vehicle}: {why}")
        self._try(self._vehicle.lose(self._clock(), why))

    def _warn(self, what: str) -> None:
        if self._seldom.is_due(what, self._clock()):
            LOG.warning("%s", plain(what, 300))

    def _try(self, messages: Iterable[Message]) -> None:
        """Send messages that belong to no command; a loss is noticed soon by its missing effect."""
        try:
            self._do(messages)
        except (NotConnected, SchemaMismatch) as error:
            LOG.debug("%s", error)

    def _do(self, messages: Iterable[Message]) -> None:
        for message in messages:
            if isinstance(message, Report):
                self._hear(message)
            elif isinstance(message, Publish):
                self._publish(message)
            else:
                self._warn(message.text)

    def _publish(self, message: Publish) -> None:
        assert self._client is not None
        body = {**self._headers(message.topic), **message.body}
        payload = to_bytes(self._settings.version, message.topic, body)
        self._client.publish(
            Publication(topic=f"{self._settings.topics}/{message.topic}", payload=payload, qos=0)
        )
