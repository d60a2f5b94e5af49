"""Lines on a mapping for a person: how much is believed by it, and examples of the values of verbs."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from arboleda.drivers import Device, DeviceVerb, Evidence, Facts
from arboleda_drivers.plc.checks import Problem

LEVELS = {Evidence.IDS: "ids", Evidence.JOINTS: "facts", Evidence.STATE: "state"}
"""The words of a plant file for the evidence of a device."""
BELIEVED = {
    Evidence.IDS: "it says which command it has done",
    Evidence.JOINTS: "it is done once the facts say so; an order that came twice, or late, is not noticed",
    Evidence.STATE: "only that it works and stops is known; what it did is not checked",
}
EXAMPLES = 4  # of a verb, that are shown


def unproven(device: Device, proves: Evidence) -> Iterator[Problem]:
    """A problem of a device of which the plant file says more than its mapping proves."""
    order = [*LEVELS]
    if order.index(device.evidence) < order.index(proves):
        said, proven = LEVELS[device.evidence], LEVELS[proves]
        yield (), f"{device.name} has evidence: {said}, and this mapping proves {proven}"


def headline(device: str, level: Evidence, believed: str = "") -> str:
    """The line on how much is believed of what a device says."""
    return f"{device}: evidence {LEVELS[level]}: {believed or BELIEVED[level]}"


def examples(verb: DeviceVerb) -> Iterator[tuple[str, Facts]]:
    """The verb with values of its parameters, in words and as such."""
    for values in islice(verb.samples, EXAMPLES):
        yield " ".join([verb.name, *(str(value) for _, value in values)]), values
