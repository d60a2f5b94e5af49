"""The invariants by which plants are judged."""

from __future__ import annotations

from .invariants import Invariant
from .invariants.advice import ADVICE
from .invariants.beliefs import BELIEFS
from .invariants.bridge import BRIDGE
from .invariants.choices import CHOICES
from .invariants.commands import COMMANDS
from .invariants.devices import DEVICES
from .invariants.grips import GRIPS
from .invariants.hosts import HOSTS
from .invariants.kinds import KINDS
from .invariants.liveness import LIVENESS
from .invariants.memory import MEMORY
from .invariants.memory_bounds import BOOKS
from .invariants.motion import MOTION
from .invariants.oee import OEE
from .invariants.part_places import PLACES
from .invariants.proofs import PROOFS
from .invariants.revisions import REVISIONS
from .invariants.screens import SCREENS
from .invariants.starts import STARTS
from .invariants.stop import STOP
from .invariants.tasks import TASKS
from .invariants.teaching import TEACHING
from .invariants.texts import TEXTS
from .invariants.verbs import VERBS
from .invariants.wire import WIRE
from .invariants.zones import ZONES

INVARIANTS: tuple[Invariant, ...] = (
    *ZONES,
    *MOTION,
    *GRIPS,
    *STOP,
    *COMMANDS,
    *PROOFS,
    *WIRE,
    *BRIDGE,
    *BELIEFS,
    *TASKS,
    *CHOICES,
    *TEXTS,
    *VERBS,
    *ADVICE,
    *MEMORY,
    *LIVENESS,
    *BOOKS,
    *OEE,
    *SCREENS,
    *STARTS,
    *DEVICES,
    *KINDS,
    *PLACES,
    *TEACHING,
)
"""Invariants of every plant."""


def judged_by(*, standby: bool = False, revises: bool = False) -> tuple[Invariant, ...]:
    """The invariants for a run: where there are two hosts, or versions, what must hold of those, too."""
    beside = (*(HOSTS if standby else ()), *(REVISIONS if revises else ()))
    return (*INVARIANTS, *beside) if beside else INVARIANTS
