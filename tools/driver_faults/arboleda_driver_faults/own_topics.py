"""Campaign of a device that is mapped by its topics: the driver at the virtual one of its mapping."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from random import Random

from arboleda.drivers import Device, NotSent, Report
from arboleda.model.commands import Command, Stop
from arboleda.model.messages import Reason
from arboleda.model.plant_model import PlantModel, Robot
from arboleda.wire.transport import Delivery, Publication
from arboleda_drivers.connections.link import LogLine
from arboleda_drivers.mqtt_mapping.machine import MappedDevice, Message
from arboleda_drivers.mqtt_mapping.settings import Settings
from arboleda_drivers.mqtt_mapping.virtual.machine import FAULTS, VirtualMapped
from arboleda_lines.line import Line

from .rig import START_S, Causes, Hear, Rig

NO_LINK = {Reason.LINK_LOST}
CAUSES: Causes = {
    "vanish": NO_LINK,
    "deaf": {Reason.DEADLINE, Reason.STOP_UNCONFIRMED},
    "mute": {*NO_LINK, Reason.DEADLINE},
    "refuse": {Reason.DEVICE_FAULT, Reason.DEADLINE, Reason.REJECTED},
    "stick": {Reason.DEADLINE},
    "lie": {Reason.NOT_REACHED, Reason.STOPPED_SHORT, Reason.DEADLINE},
    "double": set(),
    "slow": {Reason.DEADLINE},
}


class TopicsRig(Rig):
    """Test with an arm that swings; it sees the arm's true angle."""

    driver = "mqtt"
    causes = CAUSES
    work = (90, 0)

    def __init__(self, example: PlantModel) -> None:
        super().__init__(FAULTS)
        self.model = example
        (device,) = example.robots.values()
        assert isinstance(device, Device) and device.driver is not None
        assert isinstance(device.driver.settings, Settings)
        self._device, self._settings = device, device.driver.settings
        self._thing = VirtualMapped(device, self._settings, self.faults)
        self._given, self.now = 0, START_S

    @property
    def robots(self) -> Sequence[Robot]:
        return [self._device]

    def task(self, number: int) -> str:
        return f"desk swing #{number}"

    def join(self, hear: Hear, now: float) -> Loopback:
        return Loopback(self, MappedDevice(self._device, self._settings), self._thing, hear, now)

    def place(self) -> Hashable:
        return self._thing.facts["angle"]

    @property
    def where(self) -> Hashable:
        return (self.place(), self.now if self._thing.doing is not None else 0.0)

    def moves(self) -> tuple[int, int]:
        return (self._thing.begun, self._given)

    def give(self, command: Command) -> None:
        """Note a command given to the driver."""
        self._given += not isinstance(command, Stop)


class Loopback:
    """Driver and virtual device at a line in place of a broker, which keeps what is retained."""

    def __init__(
        self, rig: TopicsRig, driver: MappedDevice, thing: VirtualMapped, hear: Hear, now: float
    ) -> None:
        self._rig, self._driver, self._thing, self._hear, self._now = rig, driver, thing, hear, now
        self._is_cut = False
        self._kept: dict[str, Publication] = {}
        self.line = Line(Random(0))
        self._do(driver.connected(now, up=True))
        self._say(thing.begin())

    @property
    def next_deadline(self) -> float:
        due = (self._driver.next_deadline, self._thing.next_deadline, self.line.next_deadline)
        return max(self._now, min(due))

    def ask(self, command: Command) -> str | None:
        """Command the device; returns the reason why the command could not leave, or None."""
        self._rig.give(command)
        try:
            self._do(self._driver.command(self._now, command))
        except NotSent as error:
            return str(error)
        self._settle()
        return None

    def pass_time(self, now: float) -> None:
        """Let both do everything due by now."""
        self._now = self._rig.now = now
        self._join()
        if now >= self._thing.next_deadline:
            self._say(self._thing.step(now))
        self._do(self._driver.step(now))
        self._settle()

    def cut(self) -> None:
        """Have the driver's connection to the broker end, and begin anew."""
        self.line.broken()
        for up in (False, True):
            self._do(self._driver.connected(self._now, up=up))
        for kept in self._kept.values():
            self.line.answers(self._now, kept)

    def _join(self) -> None:
        """Let the device leave the broker, or come back, by its faults."""
        is_cut = "vanish" in self._rig.faults
        if is_cut and not self._is_cut and (will := self._thing.will()) is not None:
            self._say([will])
        elif self._is_cut and not is_cut:
            self._say(self._thing.begin())
        self._is_cut = is_cut

    def _settle(self) -> None:
        while True:
            sent, arrived = [*self.line.sent(self._now)], [*self.line.arrived(self._now)]
            for each in sent:
                self._say(self._thing.heard(self._now, each.topic, each.payload, each.about))
            for each in arrived:
                message = Delivery(self._now, each.topic, each.payload, False, each.about)
                self._do(self._driver.heard(self._now, message))
            if not (sent or arrived):
                return

    def _say(self, messages: Sequence[Publication]) -> None:
        for message in messages:
            if message.retain:
                self._kept[message.topic] = message
            self.line.answers(self._now, message)

    def _do(self, messages: Sequence[Message]) -> None:
        for message in messages:
            if isinstance(message, Report):
                self._hear(message)
            elif not isinstance(message, LogLine):
                self.line.asks(self._now, message)
