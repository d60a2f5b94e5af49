"""Refusal of a start that lacks a package which its plant needs."""

from __future__ import annotations

from typing import Protocol

from arboleda.model.errors import StartError
from arboleda.model.packages import FLEET, MISSING, TREES
from arboleda.model.sentence import Phrase

from .registry import Assembly

LEAD = Phrase("package.lead", "Leading a plant whose database several hosts reach")
GROOT2 = Phrase("package.groot2", "Showing trees to Groot2")
OPCUA = Phrase("package.opcua_view", "`opcua_view` of the plant file")


class LeadKeeper(Protocol):
    """Part that renews the lead of this process until the plant ends."""

    def stop(self) -> None: ...


class OpcUaView(Protocol):
    """Part that shows the plant over OPC UA."""

    def stop(self) -> None: ...


class Groot2View(Protocol):
    """Part that shows trees to Groot2."""

    def stop(self) -> None: ...


def wants_groot2(assembly: Assembly) -> bool:
    """True if trees are to be shown to Groot2: by the command line, or else by the plant file."""
    by_option = assembly.options.groot2
    return assembly.model.groot2_port is not None if by_option is None else by_option


def refuse_missing(assembly: Assembly) -> None:
    """Raise StartError, with the line that installs it, if a package is not there that the plant needs."""
    if "orchestrator" not in assembly.parts:
        return
    if assembly.holdings.memory.lead.renew_s is not None and assembly.ask(LeadKeeper) is None:
        raise StartError(MISSING(what=LEAD(), package=FLEET))
    if assembly.model.opcua_view is not None and assembly.ask(OpcUaView) is None:
        raise StartError(MISSING(what=OPCUA(), package=FLEET))
    if wants_groot2(assembly) and assembly.ask(Groot2View) is None:
        raise StartError(MISSING(what=GROOT2(), package=TREES))
