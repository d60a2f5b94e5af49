"""Invariants: rules that hold after every step, each a small function with one sentence."""

from __future__ import annotations

from .advice import ADVICE
from .beliefs import BELIEFS
from .bridge import BRIDGE
from .choices import CHOICES
from .commands import COMMANDS
from .grip import GRIP
from .invariant import Invariant
from .liveness import LIVENESS
from .memory import MEMORY
from .memory_bounds import BOOKS
from .motion import MOTION
from .oee import OEE
from .proofs import PROOFS
from .screens import SCREENS
from .starts import STARTS
from .stop import STOP
from .tasks import TASKS
from .texts import TEXTS
from .verbs import VERBS
from .wire import WIRE
from .work import WORK
from .zones import ZONES

__all__ = ["INVARIANTS", "Invariant"]

INVARIANTS: tuple[Invariant, ...] = (
    *ZONES,
    *MOTION,
    *GRIP,
    *STOP,
    *COMMANDS,
    *PROOFS,
    *WIRE,
    *BRIDGE,
    *BELIEFS,
    *TASKS,
    *CHOICES,
    *TEXTS,
    *WORK,
    *VERBS,
    *ADVICE,
    *MEMORY,
    *LIVENESS,
    *BOOKS,
    *OEE,
    *SCREENS,
    *STARTS,
)
