"""A vehicle behind the driver, both as machines: messages are checked both ways, time is moved by hand."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from arboleda.adapters.vda5050.messages import Headers, from_bytes, to_bytes
from arboleda.app.config import load
from arboleda.drivers.vda5050.machine import Message, Publish, Vehicle
from arboleda.drivers.vda5050.settings import Settings
from arboleda.kinds.declared import Device
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Command, Stop, StopMode
from arboleda.model.facts import Value
from arboleda.model.messages import Report
from arboleda.model.plant_model import Robot
from arboleda.virtual.faults import Faults
from arboleda.virtual.vda5050.faults import FAULTS
from arboleda.virtual.vda5050.machine import Connect, Cut, Heard, Say, VirtualAgv

EXAMPLE = Path(__file__).parents[3] / "examples/agv/plant.yaml"
STEP_S = 0.05
MAKER = {"manufacturer": "arboleda", "serial": "agv1"}


@cache
def devices() -> tuple[Robot, ...]:
    """The cart and its forks."""
    return tuple(load(EXAMPLE).robots.values())


class Rig:
    """The cart of examples/agv with a virtual vehicle; `said` is the last report of each device."""

    def __init__(self, version: str = "2.1", **settings: Any) -> None:
        self.devices = devices()
        self.settings = Settings(broker="nowhere", version=version, **MAKER, **settings)  # type: ignore[arg-type]
        self.vehicle = Vehicle(self.devices, self.settings, mark="m")
        self.faults = Faults(FAULTS)
        self.agv = VirtualAgv(self.faults, version=version)
        self.now = 0.0
        self.said: dict[str, Report] = {}
        self.told: list[tuple[str, dict[str, Any]]] = []
        self._version = version
        self._to_agv, self._headers = Headers(version, **MAKER), Headers(version, **MAKER)
        self._events: list[Heard] = []
        self._hear(self.vehicle.connected(0.0, up=True))

    def send(self, command: Command) -> None:
        self._hear(self.vehicle.command(self.now, command))

    def drive(self, *nodes: int, id: str = "1-1") -> None:
        self.send(FollowPath(id=id, robot="cart", nodes=nodes))

    def do(self, verb: str, *, id: str = "1-2", **values: Value) -> None:
        forks = next(device for device in self.devices if isinstance(device, Device))
        self.send(forks.kind.command(id=id, robot="forks", verb=verb, values=values))

    def stop(self, mode: StopMode) -> None:
        self.send(Stop(id="1-9", robot="cart", mode=mode))

    def run(self, seconds: float) -> None:
        """Let time pass."""
        for _ in range(round(seconds / STEP_S)):
            self.now = round(self.now + STEP_S, 6)
            events, self._events = self._events, []
            for message in self.agv.step(self.now, events):
                self._from_agv(message)
            self._hear(self.vehicle.step(self.now))

    def _from_agv(self, message: Say | Connect | Cut) -> None:
        if isinstance(message, Say):
            body = {**self._headers(message.topic), **message.body}
            if message.fits:
                payload = to_bytes(self._version, message.topic, body)
                said = from_bytes(self._version, message.topic, payload)
                self._hear(self.vehicle.state(self.now, said))
            return
        if isinstance(message, Connect) and message.anew:
            self._headers = Headers(self._version, **MAKER)
        word = "ONLINE" if isinstance(message, Connect) else "CONNECTIONBROKEN"
        self._hear(self.vehicle.connection(self.now, {"connectionState": word}))

    def _hear(self, messages: list[Message]) -> None:
        for message in messages:
            if isinstance(message, Publish):
                body = {**self._to_agv(message.topic), **message.body}
                said = from_bytes(self._version, message.topic, to_bytes(self._version, message.topic, body))
                self.told.append((message.topic, said))
                self._events.append(Heard(topic=message.topic, said=said))
            else:
                self.said[message.robot] = message
