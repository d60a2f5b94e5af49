"""Faults of every kind that can go wrong; a file for each family."""

from __future__ import annotations

from . import (
    boards,
    crashes,
    devices,
    effectors,
    foreigners,
    hosts,
    links,
    operators,
    orchestrators,
    processes,
    teachers,
    telemetry,
)
from .kind import UNHEARD, BoardKind, End, Fault, Kind

__all__ = [
    "COUNTED",
    "KINDS",
    "NOT_WITH_STANDBY",
    "OF_BOARDS",
    "OF_CRASHES",
    "OF_DEVICES",
    "OF_HOSTS",
    "OF_PLACES",
    "OF_QUEUES",
    "OF_WORK",
    "ON_ONE_HOST",
    "STICKING",
    "UNHEARD",
    "BoardKind",
    "End",
    "Fault",
    "Kind",
]

FAMILIES = (
    boards,
    devices,
    telemetry,
    effectors,
    links,
    processes,
    orchestrators,
    operators,
    foreigners,
    crashes,  # added at the end, so that seeds draw the same faults of the others as before
    hosts,
    teachers,
)
KINDS: dict[str, Kind] = {kind.name: kind for family in FAMILIES for kind in family.KINDS}

OF_BOARDS = {name: kind for name, kind in KINDS.items() if isinstance(kind, BoardKind)}
"""The kinds that need boards and their connections alone, and so can befall those of a real start."""

OF_DEVICES = tuple(kind.name for kind in devices.KINDS)
"""The kinds that befall devices of declared kinds alone: nobody in the packaged plants."""

OF_WORK = tuple(kind.name for family in (devices, effectors) for kind in family.KINDS)
"""The kinds in which a device or an effector does its work badly, or says so falsely."""

OF_PLACES = ("operator_load",)
"""The kinds that befall cells with places alone, which the packaged plants have not."""

OF_CRASHES = ("plant_crash", *(kind.name for kind in crashes.KINDS))
"""The kinds in which the plant dies; they are drawn at a level of their own."""

OF_QUEUES = (operators.double_submit.name, operators.bad_task.name)
"""The kinds that meet the queue of a cell, and no device."""

STICKING = (telemetry.stuck_bit.name, devices.stale_fact.name)
"""The kinds in which a device goes on to tell the same, of what their word names."""

COUNTED = crashes.COUNTED
"""Those of them that come at a commit or a message, by its number."""

OF_HOSTS = tuple(kind.name for kind in hosts.KINDS)
"""The kinds that befall two hosts: only where a standby is simulated."""

NOT_WITH_STANDBY = frozenset({*OF_CRASHES, "plant_freeze", "bridge_restart"})
"""The kinds that are of a plant on one host: with a standby others stand for them."""

ON_ONE_HOST = {name: kind for name, kind in KINDS.items() if name not in OF_HOSTS}
"""The kinds that befall a plant where no standby is simulated."""
