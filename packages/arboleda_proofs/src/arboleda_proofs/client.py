"""Methods of this package for the client of a plant: of each `Plant`, and with types, `Proofs(plant)`."""

from __future__ import annotations

from arboleda.client import Awaiting, Blocking, Routes, flow, route
from arboleda.client.line import LOOK_S

from .answers import FaultList, ProvokedFault, TaskReport

__all__ = ["AsyncProofs", "Proofs"]
REPORT_S = 120.0  # the record of a long task takes a while to be executed again


class Faults(Routes):
    """Has faults of the simulator happen to virtual devices."""

    @route("GET", "/api/faults", FaultList)
    def faults(self) -> None:
        """The faults that were provoked and go on, and those that can be."""

    @route("POST", "/api/faults", ProvokedFault)
    def provoke(self, kind: str, robot: str, seconds: float | None = None) -> None:
        """Have a fault happen to a virtual device, for 5 s where no time is given and the kind lasts."""

    @route("POST", "/api/faults/end", list[ProvokedFault])
    def end_faults(self, robot: str = "", number: int | None = None) -> None:
        """End faults before their time: one by its number, all of a device, or all; those that went on."""


class Reports(Routes):
    """Reads the reports of tasks."""

    @route("GET", "/api/tasks/{task_id}/report", TaskReport)
    def _report(self, task_id: str) -> None:
        """The report as it is now."""

    @flow("GET /api/tasks/{task_id}/report")
    async def report(self, task_id: str, *, within_s: float = REPORT_S) -> TaskReport:
        """The cause of a task's failure, and the evidence. The plant may have to write it first, out of its
        record; after `within_s` it is as it is then. NotFound, with the reason, where there is none."""
        until = self._line.clock() + within_s
        while True:
            report: TaskReport = await Reports._report.work(self, task_id)
            if report.state == "written" or self._line.clock() >= until:
                return report
            await self._line.http.sleep(LOOK_S)


class ProofsRoutes(Faults, Reports):
    """Methods that a plant has where this package is installed."""


class Proofs(ProofsRoutes, Blocking):
    """Methods of Proofs for a plant, with types: `Proofs(plant).report(id)` is `plant.report(id)`."""


class AsyncProofs(ProofsRoutes, Awaiting):
    """Methods of Proofs for an AsyncPlant, to be awaited."""
