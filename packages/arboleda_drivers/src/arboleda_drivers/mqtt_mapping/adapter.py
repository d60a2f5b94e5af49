"""The driver `mqtt`: devices at an MQTT broker, mapped by their topics."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from arboleda.drivers import Command, NotSent, Report, Robot, Stop, driver
from arboleda.wire.transport import Delivery, Publication
from arboleda_drivers.connections.device_feed import taking
from arboleda_drivers.connections.mqtt_driver import MqttDriver

from .heard import matches
from .machine import MappedDevice, Message, device_of
from .settings import Settings

NUMBERS = 1000  # of orders that a start may give before it meets those of another; its square is `MOST`


@driver("mqtt", settings=Settings)
class Mqtt(MqttDriver):
    """Driver of all devices with one mapping."""

    def __init__(self, settings: Settings) -> None:
        super().__init__(settings.broker, settings.version)
        self._settings = settings
        self._devices: dict[str, MappedDevice] = {}
        self._filters: dict[str, list[str]] = {}  # of each device

    def begin(self, devices: Sequence[Robot], mark: str, broker: str) -> Sequence[str]:
        self._settings = replace(self._settings, broker=broker)
        first = 1 + int(mark, 16) % NUMBERS * NUMBERS
        for device in devices:
            self._devices[device.name] = device_of(device, self._settings, first=first)
            name = self._settings.name_of(device.name)
            self._filters[device.name] = [*dict.fromkeys(each.named(name) for each in self._settings.sources)]
        return [*dict.fromkeys(topic for topics in self._filters.values() for topic in topics)]

    def connected(self, *, up: bool) -> None:
        for machine in self._devices.values():
            self._try(machine.connected(self.clock(), up=up))

    def take(self, message: Delivery) -> None:
        for name, filters in self._filters.items():
            if any(matches(filter, message.topic) for filter in filters):
                with taking(message.payload, self.warn):
                    self._try(self._devices[name].heard(self.clock(), message))

    def tick(self) -> float:
        now = self.clock()
        for machine in self._devices.values():
            self._try(machine.step(now))
        return min(machine.next_deadline for machine in self._devices.values()) - now

    def give(self, command: Command) -> None:
        machine, has_left = self._devices[command.robot], False
        for message in machine.command(self.clock(), command):
            try:
                self._do(message)
            except NotSent:
                if has_left and not isinstance(command, Stop):
                    return  # the rest of an order must not follow over the next connection
                machine.unsent(command)
                raise
            has_left = has_left or isinstance(message, Publication)

    def _try(self, messages: Iterable[Message]) -> None:
        """Do what belongs to no command; a loss is noticed by its missing effect."""
        for message in messages:
            try:
                self._do(message)
            except NotSent:
                continue

    def _do(self, message: Message) -> None:
        if isinstance(message, Report):
            self.hear(message)
        elif isinstance(message, Publication):
            self.publish(message)
        else:
            self.warn(message.text)
