"""Drivers of arms behind TCP with their virtual controllers; what a test does to them, and sees of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from arboleda.drivers import Home, MoveJoints, Report, SetEffector, Stop, StopMode
from arboleda.model.plant_model import Evidence, Link
from arboleda.testing.plants import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda_driver_faults import dobot, ur
from arboleda_drivers.dobot.virtual.machine import FAULTS as DOBOT_FAULTS
from arboleda_drivers.dobot.virtual.machine import VirtualDobot
from arboleda_drivers.ur.virtual.faults import FAULTS as UR_FAULTS
from arboleda_drivers.ur.virtual.machine import VirtualUr
from arboleda_drivers.virtual.faults import Faults

START_S = 100.0
PERIOD_S = 0.04  # a fifth of the frames of an arm by Universal Robots is enough to see every state
ARM = replace(StorageLayout(shipped("sis_c").cells[0]).arm, link=Link.DRIVER, evidence=Evidence.IDS)
GOAL = tuple(math.radians(each) for each in (10, 20, -30, 0, 5, 0))
GO = MoveJoints(id="9-1", robot=ARM.name, q=GOAL)
HALT = Stop(id="9-5", robot=ARM.name, mode=StopMode.HALT)
LATCH = Stop(id="9-6", robot=ARM.name, mode=StopMode.LATCH)
CLEAR = Stop(id="9-7", robot=ARM.name, mode=StopMode.CLEAR)
READY = Home(id="9-2", robot=ARM.name)
GRIP = SetEffector(id="9-3", robot=ARM.name, on=True)


class _Heard:
    """`reports` is all that the plant would hear."""

    now: float
    next_deadline: Any
    pass_time: Any
    reports: list[Report]

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


class Dobot(_Heard, dobot.Loopback):
    """Driver and virtual Dobot."""

    stop_line = "Stop()"

    def __init__(self, *on: str, ready: bool = True) -> None:
        self.faults, self.reports = Faults(DOBOT_FAULTS, on), []
        dobot = VirtualDobot(self.faults, enabled=ready, unix_s=1_700_000_000.0)
        super().__init__(ARM, dobot, self.reports.append, START_S)

    @property
    def told(self) -> list[str]:
        """The moves and stops that it was told."""
        return [line for line in self.received if line.startswith(("MovJ", "Stop"))]


class Ur(_Heard, ur.Loopback):
    """Driver and virtual arm of Universal Robots."""

    stop_line = "stopj"

    def __init__(self, *on: str, ready: bool = True) -> None:
        self.faults, self.reports = Faults(UR_FAULTS, on), []
        ur = VirtualUr(self.faults, running=ready, period_s=PERIOD_S)
        super().__init__(ARM, ur, self.reports.append, START_S)

    @property
    def told(self) -> list[str]:
        """The programs that it was told."""
        return self.programs


RIGS: dict[str, type[Dobot | Ur]] = {"dobot": Dobot, "ur": Ur}
Rig = Dobot | Ur
