"""A plant of `examples/own_topics` under the shipped core: its drivers, and virtual ones of its mappings."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tests.packages import ROOT

from arboleda.drivers import Command, Device, NotSent, Report, Robot
from arboleda.plant_file.loader import load
from arboleda.wire.transport import Delivery, Publication
from arboleda_driver_faults.rig import START_S, Hear, Rig
from arboleda_drivers.mqtt_mapping.machine import MappedDevice, Message
from arboleda_drivers.mqtt_mapping.settings import Settings
from arboleda_drivers.mqtt_mapping.virtual.machine import FAULTS, VirtualMapped

FOLDER = ROOT / "examples/own_topics"
FILES = sorted(file.stem for file in FOLDER.glob("*.yaml"))


class TopicsRig(Rig):
    """All devices of one example; what they truly did is in `things`."""

    driver, causes, work = "mqtt", {}, ()

    def __init__(self, file: str, task: str = "") -> None:
        super().__init__(FAULTS)
        self.model, self._task = load(FOLDER / f"{file}.yaml"), task
        self.devices = {name: _mapped(robot) for name, robot in self.model.robots.items()}
        self.things = {
            name: VirtualMapped(device, settings, self.faults)
            for name, (device, settings) in self.devices.items()
        }

    @property
    def robots(self) -> Sequence[Robot]:
        return [device for device, _ in self.devices.values()]

    @property
    def done(self) -> list[str]:
        """The deeds of the devices."""
        return [f"{name} {verb}" for name, thing in self.things.items() for verb in thing.done]

    def task(self, number: int) -> str:
        return self._task

    def join(self, hear: Hear, now: float) -> Pairs:
        return Pairs(self, hear, now)

    def place(self) -> None:
        return None

    def moves(self) -> tuple[int, int]:
        return 0, 0


class Pairs:
    """Each device of a rig and its driver; each gets the other's messages at once."""

    def __init__(self, rig: TopicsRig, hear: Hear = lambda report: None, now: float = START_S) -> None:
        self._things, self._hear, self.now = rig.things, hear, now
        self.drivers = {name: MappedDevice(*device) for name, device in rig.devices.items()}
        self.reports: dict[str, Report] = {}
        self.sent: list[Publication] = []
        for name, driver in self.drivers.items():
            self._do(name, driver.connected(now, up=True))
            self._say(name, self._things[name].begin())

    @property
    def next_deadline(self) -> float:
        both = [*self.drivers.values(), *self._things.values()]
        return min(each.next_deadline for each in both)

    def ask(self, command: Command) -> str | None:
        try:
            self._do(command.robot, self.drivers[command.robot].command(self.now, command))
        except NotSent as error:
            return str(error)
        return None

    def pass_time(self, now: float) -> None:
        self.now = now
        for name, driver in self.drivers.items():
            if now >= self._things[name].next_deadline:
                self._say(name, self._things[name].step(now))
            self._do(name, driver.step(now))

    def tell(self, name: str, topic: str, payload: str) -> None:
        """Say something in place of a device."""
        self._say(name, [Publication(topic, payload.encode(), 0)])

    def _do(self, name: str, messages: Iterable[Message]) -> None:
        for each in messages:
            if isinstance(each, Report):
                self.reports[name] = each
                self._hear(each)
            elif isinstance(each, Publication):
                self.sent.append(each)
                self._say(name, self._things[name].heard(self.now, each.topic, each.payload))

    def _say(self, name: str, messages: Iterable[Publication]) -> None:
        for each in messages:
            self._do(
                name, self.drivers[name].heard(self.now, Delivery(self.now, each.topic, each.payload, False))
            )


def _mapped(robot: Robot) -> tuple[Device, Settings]:
    assert isinstance(robot, Device) and robot.driver is not None
    settings = robot.driver.settings
    assert isinstance(settings, Settings)
    return robot, settings
