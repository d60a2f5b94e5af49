"""Driver and virtual vehicle, connected without a broker, under a clock that is moved by hand.

Messages are bytes on the way, and are held against the standard's schemas on both sides.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from random import Random
from typing import Any

from arboleda.drivers import NotSent
from arboleda.model.commands import Command
from arboleda.model.messages import Report
from arboleda.model.plant_model import Robot
from arboleda_drivers.connections.link import LogLine
from arboleda_drivers.vda5050.machine import Message, Publish, Vehicle
from arboleda_drivers.vda5050.messages import Headers, from_bytes, to_bytes
from arboleda_drivers.vda5050.settings import Settings
from arboleda_drivers.vda5050.virtual.machine import (
    Connect,
    ConnectionCut,
    OutgoingMessage,
    VehicleMessage,
    VirtualAgv,
)
from arboleda_drivers.vda5050.virtual.machine import Message as Said
from arboleda_drivers.vda5050.virtual.words import BROKEN
from arboleda_lines.line import Line


class Loopback:
    """Driver and virtual vehicle, connected: each gets the other's messages at once.

    `hear` takes the reports that the plant would get of the devices.
    """

    def __init__(
        self,
        devices: Sequence[Robot],
        settings: Settings,
        agv: VirtualAgv,
        hear: Callable[[Report], None],
        now: float = 0.0,
    ) -> None:
        self.agv, self.now = agv, now
        self.vehicle = Vehicle(devices, settings, mark="m")
        self.received: list[tuple[str, dict[str, Any]]] = []  # topics and messages
        self.log: list[str] = []
        self._settings, self._hear = settings, hear
        self._names = (settings.version, settings.manufacturer, settings.serial)
        self._to_agv, self._headers = Headers(*self._names), Headers(*self._names)
        self._connected = False
        self.line = Line(Random(0))
        self._do(self.vehicle.connected(now, up=True))
        if agv.is_online:  # which the broker retains
            self._take(Connect(anew=False))

    @property
    def next_deadline(self) -> float:
        due = (self.agv.next_deadline, self.vehicle.next_deadline, self.line.next_deadline)
        return max(self.now, min(due))

    def ask(self, command: Command) -> str | None:
        """Command a device; returns the reason why the command could not leave, or None."""
        try:
            self.send(command)
        except NotSent as error:
            return str(error)
        return None

    def send(self, command: Command) -> None:
        """Command a device; raises NotSent if the command could not leave."""
        self._do(self.vehicle.command(self.now, command))
        self._settle()

    def pass_time(self, now: float) -> None:
        """Let both do everything due by now."""
        self.now = now
        self._step_agv()
        self._do(self.vehicle.step(now))
        self._settle()

    def cut(self) -> None:
        """Have the driver's connection to the broker end, and begin anew."""
        self.line.broken()
        for up in (False, True):
            self._do(self.vehicle.connected(self.now, up=up))
        if self._connected:  # which the broker retains
            self._do(self.vehicle.connection(self.now, {"connectionState": "ONLINE"}))

    def _settle(self) -> None:
        while True:
            sent = [*self.line.sent(self.now)]
            for said in sent:
                self._step_agv(said)
            arrived = [*self.line.arrived(self.now)]
            for each in arrived:
                self._read(each)
            if not (sent or arrived):
                return

    def _step_agv(self, *heard: VehicleMessage) -> None:
        for message in self.agv.step(self.now, heard):
            self._take(message)

    def _take(self, message: Said) -> None:
        if isinstance(message, OutgoingMessage):
            if message.fits:
                self.line.answers(self.now, message)
            return
        self._connected = isinstance(message, Connect)
        if isinstance(message, ConnectionCut):
            self.line.broken()
        elif message.anew:
            self._headers = Headers(*self._names)
        word = "ONLINE" if self._connected else BROKEN[self._settings.version]
        self._do(self.vehicle.connection(self.now, {"connectionState": word}))

    def _read(self, say: OutgoingMessage) -> None:
        version = self._settings.version
        body = {**self._headers(say.topic), **say.body}
        parsed = from_bytes(version, say.topic, to_bytes(version, say.topic, body))
        if say.as_serial is None:
            heard = self.vehicle.factsheet if say.topic == "factsheet" else self.vehicle.state
            self._do(heard(self.now, parsed))

    def _do(self, messages: Iterable[Message]) -> None:
        for message in messages:
            if isinstance(message, Publish):
                self._publish(message)
            elif isinstance(message, LogLine):
                self.log.append(message.text)
            else:
                self._hear(message)

    def _publish(self, message: Publish) -> None:
        version, body = self._settings.version, {**self._to_agv(message.topic), **message.body}
        parsed = from_bytes(version, message.topic, to_bytes(version, message.topic, body))
        self.received.append((message.topic, parsed))
        if self._connected:
            self.line.asks(self.now, VehicleMessage(topic=message.topic, body=parsed))
