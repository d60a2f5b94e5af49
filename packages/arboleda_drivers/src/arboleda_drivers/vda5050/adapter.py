"""The driver `vda5050`: one vehicle at an MQTT broker."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from arboleda.drivers import Command, NotSent, Report, Robot, driver, plain, quoted
from arboleda.wire.transport import Delivery, Publication
from arboleda_drivers.connections.device_feed import taking
from arboleda_drivers.connections.mqtt_driver import LOG, MqttDriver
from arboleda_drivers.vda5050.machine import Message, Publish, Vehicle
from arboleda_drivers.vda5050.settings import Settings

from .messages import Headers, SchemaMismatch, from_bytes, to_bytes

HANDLERS = {"state": Vehicle.state, "connection": Vehicle.connection, "factsheet": Vehicle.factsheet}


@driver("vda5050", settings=Settings)
class Vda5050(MqttDriver):
    """Driver of one vehicle and its devices, which repeats the known state."""

    def __init__(self, settings: Settings) -> None:
        super().__init__(settings.broker)
        self._settings = settings

    def begin(self, devices: Sequence[Robot], mark: str, broker: str) -> Sequence[str]:
        settings = self._settings
        for problem in [sentence for device in devices for _, sentence in settings.problems(device)]:
            raise ValueError(problem)
        self._vehicle = Vehicle(devices, settings, mark=mark)
        self._headers = Headers(settings.version, settings.manufacturer, settings.serial)
        return (
            *(f"{settings.topics}/{topic}" for topic in ("state", "factsheet")),
            f"{settings.interface}/+/+/+/connection",
        )

    def connected(self, *, up: bool) -> None:
        self._try(self._vehicle.connected(self.clock(), up=up))

    def give(self, command: Command) -> None:
        try:
            self._do(self._vehicle.command(self.clock(), command))
        except SchemaMismatch as error:
            self._vehicle.unsent(command)
            raise NotSent(str(error)) from error
        except NotSent:
            self._vehicle.unsent(command)
            raise

    def tick(self) -> float:
        now = self.clock()
        with taking("a state", self._lose):
            self._try(self._vehicle.step(now))
        return self._vehicle.next_deadline - now

    def take(self, message: Delivery) -> None:
        with taking(message.payload, self._lose):
            self._read(message)

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
            self.warn(f"a message on {delivery.topic} is refused: {error}")
            if topic == "state":
                self._vehicle.link.refuse(str(error))
            return
        self._try(HANDLERS[topic](self._vehicle, self.clock(), body))

    def _lose(self, why: str) -> None:
        self.warn(f"{self._settings.vehicle}: {why}")
        self._try(self._vehicle.lose(self.clock(), why))

    def _try(self, messages: Iterable[Message]) -> None:
        """Send messages that belong to no command; a loss is noticed soon by its missing effect."""
        try:
            self._do(messages)
        except (NotSent, SchemaMismatch) as error:
            LOG.debug("%s", error)

    def _do(self, messages: Iterable[Message]) -> None:
        for message in messages:
            if isinstance(message, Report):
                self.hear(message)
            elif isinstance(message, Publish):
                self._publish(message)
            else:
                self.warn(message.text)

    def _publish(self, message: Publish) -> None:
        body = {**self._headers(message.topic), **message.body}
        payload = to_bytes(self._settings.version, message.topic, body)
        topic = f"{self._settings.topics}/{message.topic}"
        self.publish(Publication(topic=topic, payload=payload, qos=0))
