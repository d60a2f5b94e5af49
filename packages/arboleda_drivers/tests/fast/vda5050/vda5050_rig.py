"""A vehicle behind the driver, both as machines: messages are checked both ways, time is moved by hand."""

from __future__ import annotations

from functools import cache
from typing import Any

from tests.packages import ROOT

from arboleda.kinds.declared import Device
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Stop, StopMode
from arboleda.model.facts import Value
from arboleda.model.messages import Report
from arboleda.model.plant_model import Robot
from arboleda.plant_file.loader import load
from arboleda_driver_faults.vda5050_loopback import Loopback
from arboleda_drivers.vda5050.settings import Settings
from arboleda_drivers.vda5050.virtual.faults import FAULTS
from arboleda_drivers.vda5050.virtual.machine import VirtualAgv
from arboleda_drivers.virtual.faults import Faults

EXAMPLE = ROOT / "examples/agv/plant.yaml"
STEP_S = 0.05
MAKER = {"manufacturer": "arboleda", "serial": "agv1"}


@cache
def devices() -> tuple[Robot, ...]:
    """The cart and its forks."""
    return tuple(load(EXAMPLE).robots.values())


class Rig(Loopback):
    """The cart of examples/agv with a virtual vehicle; `said` is the last report of each device."""

    def __init__(self, version: str = "2.1", **settings: Any) -> None:
        self.faults = Faults(FAULTS)
        self.reports: dict[str, Report] = {}
        found = Settings(broker="nowhere", version=version, **MAKER, **settings)  # type: ignore[arg-type]
        super().__init__(devices(), found, VirtualAgv(self.faults, version=version), self._keep)

    def _keep(self, report: Report) -> None:
        self.reports[report.robot] = report

    def drive(self, *nodes: int, id: str = "1-1") -> None:
        self.send(FollowPath(id=id, robot="cart", nodes=nodes))

    def do(self, verb: str, *, id: str = "1-2", **values: Value) -> None:
        forks = next(device for device in devices() if isinstance(device, Device))
        self.send(forks.kind.command(id=id, robot="forks", verb=verb, values=values))

    def stop(self, mode: StopMode) -> None:
        self.send(Stop(id="1-9", robot="cart", mode=mode))

    def run(self, seconds: float) -> None:
        """Let time pass."""
        for _ in range(round(seconds / STEP_S)):
            self.pass_time(round(self.now + STEP_S, 6))
