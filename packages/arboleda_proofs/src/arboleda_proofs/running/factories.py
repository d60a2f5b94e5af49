"""Factories of reports, of faults by hand, and of the demonstration."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict

from arboleda.runtime.demo_options import DemoOptions
from arboleda.runtime.factories.plant import RecordPart
from arboleda.runtime.parts.devices import DeviceBench, DevicesPart
from arboleda.runtime.parts.orchestrator import Orchestrator
from arboleda.runtime.parts.part import Part
from arboleda.runtime.registry import Assembly, Factory, Phase
from arboleda_proofs.running.api import DemonstrationApi, FaultsApi, ReportsApi


def reports(assembly: Assembly) -> Iterator[Part]:
    """The part that has reports written where there is a record: those that are asked for and, if wanted, one
    of each failure."""
    plant, wanted = assembly.ask(Orchestrator), assembly.options.recording
    if plant is None:
        return
    from .reports_part import NoReports, ReportsPart

    record = assembly.ask(RecordPart)
    if wanted is None or record is None:
        assembly.offer(ReportsApi, NoReports())
        return
    part = ReportsPart(assembly.holdings.state.path)
    assembly.offer(ReportsApi, part)
    record.wrote.append(part.wrote)
    if wanted.reports:
        plant.listeners.append(part.changed)
    yield part


def past(assembly: Assembly) -> Iterator[Part]:
    """The page on records of this plant, where it has one."""
    if assembly.ask(Orchestrator) is not None and assembly.options.page:
        from arboleda_proofs.past.desk import PastDesk

        is_recorded = assembly.options.recording is not None
        assembly.offer(PastDesk, PastDesk(assembly.holdings.state.path if is_recorded else None))
    yield from ()


def bench(assembly: Assembly) -> Iterator[Part]:
    """The bench of virtual devices, at which faults begin and end."""
    if "devices" in assembly.parts:
        from arboleda_proofs.simulator.fault_bench import FaultBench

        assembly.offer(DeviceBench, FaultBench)
    yield from ()


def faults(assembly: Assembly) -> Iterator[Part]:
    """Faults by hand at the virtual devices of this process, which are no part that starts."""
    plant, devices = assembly.ask(Orchestrator), assembly.ask(DevicesPart)
    if plant is None:
        return
    from .fault_desk import FaultDesk

    desk = FaultDesk(assembly.model, devices, plant.hear)
    assembly.offer(FaultsApi, desk)
    assembly.links.add(lambda: {"faults": [asdict(each) for each in desk.begun()]})
    if devices is not None:
        devices.noted = desk.noted
    yield from ()


def demonstration(assembly: Assembly) -> Iterator[Part]:
    """A demonstration, if wanted, where this process has plant and devices."""
    plant, devices = assembly.ask(Orchestrator), assembly.ask(DevicesPart)
    if assembly.options.of(DemoOptions) is None or plant is None or devices is None:
        return
    from .demo import Demo
    from .demo_part import DemoPart

    part = DemoPart(Demo(assembly.model), plant.submit, devices.befall, assembly.crash)
    assembly.offer(DemonstrationApi, part)
    assembly.links.add(lambda: {"demo": part.is_on})
    assembly.notes.append(lambda: part.notes)
    plant.screens.watchers.append(part.saw)
    yield part


FACTORIES = (
    Factory(phase=Phase.LINKS, make=bench),
    Factory(phase=Phase.REPORTS, make=reports),
    Factory(phase=Phase.PLANT, make=past),
    Factory(phase=Phase.PLANT, make=faults),
    Factory(phase=Phase.VIEWS, make=demonstration),
)
