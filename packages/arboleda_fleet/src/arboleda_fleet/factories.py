"""Factories for leading on several hosts, for the OEE, and for the OPC UA view."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from typing import Any

from arboleda.extension import ArboledaError
from arboleda.runtime.missing import LeadKeeper, OpcUaView
from arboleda.runtime.parts.orchestrator import Orchestrator
from arboleda.runtime.parts.part import Part
from arboleda.runtime.registry import Assembly, Factory, Phase
from arboleda.store.lead import Lead

from .oee.api import OeeApi

LOG = logging.getLogger(__name__)


def lease(assembly: Assembly) -> Iterator[Part]:
    """The part that keeps the lead of a plant whose memory several hosts reach."""
    memory = assembly.holdings.memory
    lead = memory.lead
    if lead.renew_s is None:
        return
    from arboleda.runtime.leader import way_to

    from .standby.lease import LeasePart

    def standbys() -> dict[str, Any]:
        return {
            "standbys": [{"host": each.host, "url": way_to(each.host, each.url)} for each in lead.standbys]
        }

    def hand_over() -> None:
        _hand_over(assembly.need(Orchestrator), lead, assembly.end)

    part = LeasePart(memory, lead.renew_s, assembly.crash, hand_over)
    assembly.offer(LeadKeeper, part)
    assembly.links.add(standbys)
    yield part


def _hand_over(plant: Orchestrator, lead: Lead, end: Callable[[], None]) -> None:
    """Hold the cells that are at work, so that the next leader can go on with them, and end."""
    from .standby.handover import hold_all

    LOG.warning("another process is to lead the plant: what is at work is held")
    try:
        lead.hand_over(hold_all(plant))
    except (ArboledaError, TimeoutError) as error:
        LOG.warning("the next leader is not told what was at work: %s", error)
    end()


def cell_times(assembly: Assembly) -> Iterator[Part]:
    """The part that keeps the times of the cells for the OEE, and the desk that tells the OEE."""
    plant, held = assembly.ask(Orchestrator), assembly.holdings
    if plant is None:
        return
    from .oee.cell_times import CellTimes
    from .oee.rows import OeeDesk

    part = CellTimes(held.memory.times, plant.calendar.unix_s)
    plant.observers.append(part.stepped)
    assembly.offer(OeeApi, OeeDesk(held.history, [cell.name for cell in assembly.model.cells]))
    yield part


def opcua_view(assembly: Assembly) -> Iterator[Part]:
    """The part that shows the plant over OPC UA, if wanted; on the address of the HTTP API."""
    view, plant = assembly.model.opcua_view, assembly.ask(Orchestrator)
    if view is None or plant is None:
        return
    from .oee.api import OeeQuery
    from .opcua_view.part import OpcUaViewOptions, OpcUaViewPart

    options = OpcUaViewOptions(
        host=assembly.options.web.address, port=view.port, plant=assembly.model.name, folders=view.isa95
    )
    part = OpcUaViewPart(options, lambda: assembly.need(OeeApi).oee(OeeQuery()))
    assembly.offer(OpcUaView, part)
    assembly.notes.append(lambda: part.notes)
    plant.listeners.append(part.changed)
    plant.screens.watchers.append(part.saw)
    yield part


def resumption(assembly: Assembly) -> Iterator[Part]:
    """The part that goes on with cells which the leader before held for the change alone."""
    lead, plant = assembly.holdings.memory.lead, assembly.ask(Orchestrator)
    if plant is not None and lead.renew_s is not None:
        from .standby.handover import CellResumption

        yield CellResumption(plant, lead.going, assembly.epoch)


FACTORIES = (
    Factory(phase=Phase.LINKS, make=lease, is_needed=True),  # two processes would lead one plant
    Factory(phase=Phase.RECORD, make=cell_times),
    Factory(phase=Phase.VIEWS, make=opcua_view),
    Factory(phase=Phase.AFTER, make=resumption),
)
