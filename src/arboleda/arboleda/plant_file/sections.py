"""Sections of a plant file that concern the whole plant: timing, record, ports, store, assistants."""

from __future__ import annotations

from arboleda.host.packages import entry_points, package_of
from arboleda.model.assistants import AssistantLimits, Assistants, hours
from arboleda.model.packages import FLEET, MISSING, TREES
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import OpcUaView, Timing
from arboleda.model.recording import Limits, Recording
from arboleda.model.sentence import OWN
from arboleda.store.address import has_password
from arboleda.store.schemes import GROUP as SCHEMES
from arboleda.store.schemes import objection

from .document import Document, Place, choice, shown
from .not_installed import why_nobody
from .shapes import AssistantLimitsShape, FileShape, OpcUaViewShape, RecordShape, TimingShape

ASSISTANTS, ASSISTANT_LIMITS = "assistants", "assistant_limits"
NEEDS_LIMITS = (
    'needs "assistant_limits", which names the cells: {cells: [...], at_once: 1, hours: "08:00-18:00"}'
)
NEEDS_SUBMIT = 'counts only with "assistants: submit"'
RECORD: Place = ("record",)
REPORTS: Place = ("reports",)
STORE: Place = ("store",)
ON, OFF = "on", "off"


def timing(document: Document) -> Timing | None:
    """The times of a plant; None, with the problems kept, where they cannot be read."""
    shape = document.section(TimingShape, ("timing",))
    if shape and shape.piece_debounce_s >= shape.piece_wait_s:
        rule = f"must be less than piece_wait_s, which is {shape.piece_wait_s:g}"
        document.problem(("timing", "piece_debounce_s"), f"{rule}; is {shape.piece_debounce_s:g}")
    if shape and shape.effector_settle_s > shape.effector_timeout_s:
        rule = f"must be at most effector_timeout_s, which is {shape.effector_timeout_s:g}"
        why = "else an effector that reports nothing is given up before it counts as switched"
        document.problem(("timing", "effector_settle_s"), f"{rule}, {why}; is {shape.effector_settle_s:g}")
    return None if shape is None else Timing(**shape.model_dump())


def recording(document: Document, files: PlantFiles) -> Recording | None:
    """The beginning of a plant's record; None where the plant file says `record: off`."""
    if document.value(RECORD) == OFF:
        return None
    return Recording(files=files, limits=record_limits(document) or Limits(), reports=_has_reports(document))


def record_limits(document: Document) -> Limits | None:
    """The limits of a plant's record; None, with the problems kept, where they cannot be read."""
    if document.value(RECORD) == OFF:
        if _has_reports(document):
            document.problem(REPORTS, "reports are made of the record, which is off")
        return Limits()
    shape = document.section(RecordShape, RECORD)
    return None if shape is None else Limits(**shape.model_dump())


def _has_reports(document: Document) -> bool:
    return bool(document.value(REPORTS) == ON)


def check_ports(document: Document, shape: FileShape | None) -> None:
    """Keep a problem where `groot2` leaves too few ports: each cell has two ports for Groot2."""
    if shape is not None:
        if shape.groot2 and TREES not in {package_of(each) for each in entry_points("arboleda.parts")}:
            document.problem(("groot2",), str(MISSING(what=OWN(text="groot2"), package=TREES)))
        last = 65_536 - 2 * len(shape.cells)
        if shape.groot2 > last:
            rule = f"must be at most {last}, for each of the {len(shape.cells)} cells has two ports"
            document.problem(("groot2",), f"{rule}; is {shape.groot2}")


def opcua_view(document: Document) -> OpcUaView | None:
    """The server that shows the plant; None where there is none, or, with the problems kept, a wrong one."""
    place = ("opcua_view",)
    if not document.has(place):
        return None
    if FLEET not in {package_of(each) for each in entry_points("arboleda.parts")}:
        document.problem(place, str(MISSING(what=OWN(text="opcua_view"), package=FLEET)))
    shape = document.read(OpcUaViewShape, place)
    return None if shape is None else OpcUaView(port=shape.port, isa95=tuple(shape.isa95))


def store_address(document: Document, address: str) -> str:
    """The database of the plant's memory. No problem repeats it, for there may be a password in it."""
    wrong = objection(address) if address else ""
    if wrong:
        why = why_nobody(document, SCHEMES, address.partition("://")[0])
        document.problem(STORE, why or wrong)
    elif has_password(address):
        document.problem(STORE, "has a password in it; leave it to PGPASSWORD or ~/.pgpass")
    return address


def assistant_limits(document: Document) -> AssistantLimits:
    """The limits of assistants: their cells, how many tasks at once, in which hours; problems are kept."""
    submits = document.value((ASSISTANTS,)) == Assistants.SUBMIT.value
    if not document.has((ASSISTANT_LIMITS,)):
        if submits:
            document.problem((ASSISTANTS,), NEEDS_LIMITS)
        return AssistantLimits()
    if not submits:
        document.problem((ASSISTANT_LIMITS,), NEEDS_SUBMIT)
    shape = document.read(AssistantLimitsShape, (ASSISTANT_LIMITS,))
    if shape is None:
        return AssistantLimits()
    cells = document.keys(("cells",))
    for number, name in enumerate(shape.cells):
        if name not in cells:
            document.problem(
                (ASSISTANT_LIMITS, "cells", number), f"must be {choice(cells)}, is {shown(name)}"
            )
    return AssistantLimits(
        cells=tuple(shape.cells),
        at_once=shape.at_once,
        hours=None if shape.hours is None else hours(shape.hours),
    )
