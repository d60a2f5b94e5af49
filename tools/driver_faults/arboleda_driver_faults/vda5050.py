"""Campaign of a vehicle of VDA 5050 under its faults: its loads, and the failures that each may cause."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.model.commands import Command, Stop
from arboleda.model.messages import Reason
from arboleda.model.plant_model import PlantModel, Robot
from arboleda_drivers.vda5050.settings import Settings
from arboleda_drivers.vda5050.virtual.faults import FAULTS
from arboleda_drivers.vda5050.virtual.machine import VirtualAgv

from .rig import Hear, Rig
from .vda5050_loopback import Loopback

SILENT_S = 3.0  # the shortest silence that states of each second allow
NO_LINK = {Reason.LINK_LOST}
OVER = {Reason.DEVICE_FAULT, Reason.REJECTED}
CAUSES: dict[str, set[Reason]] = {
    "vanish": NO_LINK,
    "power_cycle": {*NO_LINK, Reason.REBOOTED},
    "hush": NO_LINK,
    "frozen": NO_LINK,
    "late": {Reason.STOP_UNCONFIRMED},
    "double": set(),
    "garbled": NO_LINK,
    "wrong_serial": NO_LINK,
    "no_route": {Reason.REJECTED},
    "no_update": {Reason.DEVICE_FAULT},
    "forget": {Reason.DEVICE_FAULT},
    "short": {Reason.DEVICE_FAULT, Reason.NOT_REACHED},
    "lie": {Reason.DEVICE_FAULT, Reason.NOT_REACHED},
    "obstacle": {Reason.DEADLINE},
    "e_stop": OVER,
    "manual": OVER,
    "fatal": OVER,
    "deaf": {Reason.STOP_UNCONFIRMED},
    "action_fails": {Reason.DEVICE_FAULT},
    "action_stalls": {Reason.DEADLINE},
    "lost": {Reason.NOT_HOMED},
    "slow": {Reason.DEADLINE},
}


class AgvRig(Rig):
    """Test with a vehicle that carries things between shelves; it sees the vehicle's place and load."""

    driver = "vda5050"
    causes = CAUSES
    work = (("6", True), ("8", True), ("8", False), ("0", False))
    between_s = 14.0

    def __init__(self, example: PlantModel, version: str = "2.1") -> None:
        super().__init__(FAULTS)
        self.model = example
        self._agv = VirtualAgv(self.faults, version=version)
        names = {"broker": "nowhere", "manufacturer": "arboleda", "serial": "agv1", "version": version}
        self._settings = Settings(silent_after_s=SILENT_S, **names)  # type: ignore[arg-type]
        self._driver: ActionCounter | None = None

    @property
    def robots(self) -> Sequence[Robot]:
        return tuple(self.model.robots.values())

    def task(self, number: int) -> str:
        return f"hall fetch left right #{number}"

    def join(self, hear: Hear, now: float) -> Loopback:
        self._driver = ActionCounter(self.robots, self._settings, self._agv, hear, now)
        return self._driver

    @property
    def where(self) -> tuple[str, float]:
        since = self._driver.now if self._driver is not None and self._agv.driving else 0.0
        return (self._agv.node, since)

    def place(self) -> tuple[str, bool]:
        return (self._agv.node, self._agv.loaded)

    def moves(self) -> tuple[int, int]:
        if self._driver is None:
            return (0, 0)
        orders = [said for topic, said in self._driver.received if topic == "order"]
        return (sum(not said["orderUpdateId"] for said in orders), self._driver.given)


class ActionCounter(Loopback):
    """Machine that counts the work given to it."""

    given = 0

    def ask(self, command: Command) -> str | None:
        self.given += not isinstance(command, Stop)
        return super().ask(command)
