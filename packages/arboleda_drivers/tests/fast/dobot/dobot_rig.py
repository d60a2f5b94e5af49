"""The driver's machine and a virtual Dobot, with what a test does to them and sees of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from arboleda.drivers import MoveJoints, Report
from arboleda.model.plant_model import Evidence, Link
from arboleda.testing.plants import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda_driver_faults.dobot_loopback import Loopback as Pair
from arboleda_drivers.dobot.virtual.faults import FAULTS
from arboleda_drivers.dobot.virtual.machine import VirtualDobot
from arboleda_drivers.virtual.faults import Faults

START_S = 100.0
ARM = replace(StorageLayout(shipped("sis_c").cells[0]).arm, link=Link.DRIVER, evidence=Evidence.IDS)
GOAL = tuple(math.radians(each) for each in (10, 20, -30, 0, 5, 0))
GO = MoveJoints(id="9-1", robot=ARM.name, q=GOAL)


class Loopback(Pair):
    """`reports` is all that the plant would hear."""

    def __init__(self, *on: str, enabled: bool = True) -> None:
        self.faults = Faults(FAULTS, on)
        self.reports: list[Report] = []
        dobot = VirtualDobot(self.faults, enabled=enabled, unix_s=1_700_000_000.0)
        super().__init__(ARM, dobot, self.reports.append, START_S)

    @property
    def last(self) -> Report:
        return self.reports[-1]

    def wait(self, s: float, until: Callable[[Report], bool] | None = None) -> None:
        """Let so much time pass, or less, up to a report."""
        end = self.now + s
        while self.now < end:
            self.pass_time(min(end, max(self.next_deadline, self.now + 1e-4)))
            if until is not None and self.reports and until(self.last):
                return
