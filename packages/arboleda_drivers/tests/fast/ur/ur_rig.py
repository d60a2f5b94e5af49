"""The driver's machine and a virtual arm of Universal Robots, and what a test does to them and sees."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from arboleda.drivers import MoveJoints, Report
from arboleda.model.plant_model import Evidence, Link
from arboleda.testing.plants import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda_driver_faults.ur_loopback import Loopback as Pair
from arboleda_drivers.ur.virtual.faults import FAULTS
from arboleda_drivers.ur.virtual.machine import VirtualUr
from arboleda_drivers.virtual.faults import Faults

START_S = 100.0
PERIOD_S = 0.04  # a fifth of the frames is enough to see every state
ARM = replace(StorageLayout(shipped("sis_c").cells[0]).arm, link=Link.DRIVER, evidence=Evidence.IDS)
GOAL = tuple(math.radians(each) for each in (10, 20, -30, 0, 5, 0))
GO = MoveJoints(id="9-1", robot=ARM.name, q=GOAL)


class Loopback(Pair):
    """`reports` is all that the plant would hear."""

    def __init__(self, *on: str, running: bool = True) -> None:
        self.faults = Faults(FAULTS, on)
        self.reports: list[Report] = []
        super().__init__(
            ARM, VirtualUr(self.faults, running=running, period_s=PERIOD_S), self.reports.append, START_S
        )

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
