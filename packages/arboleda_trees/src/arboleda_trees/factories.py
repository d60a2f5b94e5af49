"""Factory of the part that shows trees to Groot2."""

from __future__ import annotations

from collections.abc import Iterator

from arboleda.runtime.missing import Groot2View, wants_groot2
from arboleda.runtime.parts.orchestrator import Orchestrator
from arboleda.runtime.parts.part import Part
from arboleda.runtime.registry import Assembly, Factory, Phase


def groot2(assembly: Assembly) -> Iterator[Part]:
    """The part that shows trees to Groot2, if wanted; on the address of the HTTP API."""
    model, running = assembly.model, assembly.ask(Orchestrator)
    if running is None or not wants_groot2(assembly):
        return
    from .groot2.part import Groot2Options, Groot2Part

    where = Groot2Options(host=assembly.options.web.address, port=model.groot2_port)
    part = Groot2Part([cell.name for cell in model.cells], where)
    assembly.offer(Groot2View, part)
    assembly.notes.append(lambda: part.notes)
    running.screens.watchers.append(part.saw)
    yield part


FACTORIES = (Factory(phase=Phase.VIEWS, make=groot2),)
