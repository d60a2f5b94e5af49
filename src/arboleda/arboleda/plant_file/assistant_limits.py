"""Limits of assistants in the plant file: the cells of their tasks, how many at once, in which hours."""

from __future__ import annotations

from arboleda.model.assistants import AssistantLimits, Assistants, hours

from .document import Document, choice, shown
from .shapes import AssistantLimitsShape

LEVEL, SECTION = "assistants", "assistant_limits"
MISSING = 'needs "assistant_limits", which names the cells: {cells: [...], at_once: 1, hours: "08:00-18:00"}'
USELESS = 'counts only with "assistants: submit"'


def assistant_limits(document: Document) -> AssistantLimits:
    """The limits; problems are kept, and then these are not the plant's."""
    submits = document.value((LEVEL,)) == Assistants.SUBMIT.value
    if not document.has((SECTION,)):
        if submits:
            document.problem((LEVEL,), MISSING)
        return AssistantLimits()
    if not submits:
        document.problem((SECTION,), USELESS)
    shape = document.read(AssistantLimitsShape, (SECTION,))
    if shape is None:
        return AssistantLimits()
    cells = document.keys(("cells",))
    for number, name in enumerate(shape.cells):
        if name not in cells:
            document.problem((SECTION, "cells", number), f"must be {choice(cells)}, is {shown(name)}")
    return AssistantLimits(
        cells=tuple(shape.cells),
        at_once=shape.at_once,
        hours=None if shape.hours is None else hours(shape.hours),
    )
