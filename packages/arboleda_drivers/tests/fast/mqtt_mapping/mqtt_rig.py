"""A mapped device and the virtual one of its mapping, connected without a broker; time is moved by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from arboleda.drivers import Device, NotSent, Report, Stop, StopMode
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.loader import load
from arboleda.wire.transport import Delivery, Publication
from arboleda_drivers.connections.link import LogLine
from arboleda_drivers.mqtt_mapping.heard import matches
from arboleda_drivers.mqtt_mapping.machine import MappedDevice, Message
from arboleda_drivers.mqtt_mapping.settings import Settings
from arboleda_drivers.mqtt_mapping.virtual.machine import FAULTS, VirtualMapped
from arboleda_drivers.virtual.faults import Faults

STEP_S = 0.05
RECIPE = """from arboleda.recipes import recipe

@recipe("none")
def none(cell):
    return cell.fail("there is nothing to do")
"""


def plant_of(folder: Path, kinds: str, mapping: str, device: str = "thing") -> PlantModel:
    """The plant of one device of the kind `thing`."""
    text = f"""name: shop
uses: [recipes.py]
kinds:
  thing:
{_indented(kinds, 4)}
cells:
  shop:
    devices:
      {device}:
        kind: thing
{_indented("" if "halt:" in mapping else "stop: none", 8)}
        driver:
          mqtt:
{_indented(mapping, 12)}
"""
    (folder / "plant.yaml").write_text(text, "utf-8")
    (folder / "recipes.py").write_text(RECIPE, "utf-8")
    return load(folder / "plant.yaml")


def device_in(plant: PlantModel) -> tuple[Device, Settings]:
    """The only device of a plant, and its settings."""
    (device,) = plant.robots.values()
    assert isinstance(device, Device) and device.driver is not None
    settings = device.driver.settings
    assert isinstance(settings, Settings)
    return device, settings


class Rig:
    """Both sides; `report` is what the plant hears last, `sent` and `said` what passed each way."""

    def __init__(self, device: Device, settings: Settings) -> None:
        self.device, self.settings = device, settings
        self.faults = Faults(FAULTS)
        self.driver = MappedDevice(device, settings)
        self.thing = VirtualMapped(device, settings, self.faults)
        self.now = 1000.0
        self.sent: list[Publication] = []
        self.log: list[str] = []
        self._do(self.driver.connected(self.now, up=True))
        self._say(self.thing.begin())

    def give(self, verb: str, id: str = "c1", **values: Any) -> None:
        """Order it; raises NotSent."""
        kind = self.device.kind
        command = kind.command(id=id, robot=self.device.name, verb=verb, values=values)
        self._do(self.driver.command(self.now, command))

    def refusal(self, verb: str, id: str = "c1", **values: Any) -> str:
        """The reason why an order does not leave; "" where it does."""
        try:
            self.give(verb, id, **values)
        except NotSent as error:
            return str(error)
        return ""

    def stop(self, mode: StopMode, id: str = "s1") -> None:
        self._do(self.driver.command(self.now, Stop(id=id, robot=self.device.name, mode=mode)))

    def tell(self, topic: str, payload: str, *, retain: bool = False, about: str = "") -> None:
        """Say something in place of the device."""
        said = Delivery(self.now, topic, payload.encode(), retain, about.encode())
        self._do(self.driver.heard(self.now, said))

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds / STEP_S)):
            self.now = round(self.now + STEP_S, 6)
            if self.now >= self.thing.next_deadline:
                self._say(self.thing.step(self.now))
            self._do(self.driver.step(self.now))

    def _do(self, messages: list[Message]) -> None:
        sent = [each for each in messages if isinstance(each, Publication)]
        self.sent += sent
        for message in messages:
            if isinstance(message, Report):
                self.report = message
            elif isinstance(message, LogLine):
                self.log.append(message.text)
        for each in sent:
            if any(matches(topic, each.topic) for topic in self.thing.topics):
                self._say(self.thing.heard(self.now, each.topic, each.payload, each.about))

    def _say(self, messages: list[Publication]) -> None:
        for message in messages:
            delivery = Delivery(self.now, message.topic, message.payload, False, message.about)
            self._do(self.driver.heard(self.now, delivery))


def _indented(text: str, by: int) -> str:
    return "\n".join(" " * by + line for line in text.strip("\n").splitlines())
