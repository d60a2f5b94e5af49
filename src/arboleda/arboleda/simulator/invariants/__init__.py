"""What must hold after every step, each a small function with one sentence."""

from __future__ import annotations

from .books import BOOKS
from .commands import COMMANDS
from .grip import GRIP
from .invariant import Invariant
from .liveness import LIVENESS
from .motion import MOTION
from .stop import STOP
from .tasks import TASKS
from .wire import WIRE
from .zones import ZONES

__all__ = ["INVARIANTS", "Invariant"]

INVARIANTS: tuple[Invariant, ...] = (
    *ZONES,
    *MOTION,
    *GRIP,
    *STOP,
    *COMMANDS,
    *WIRE,
    *TASKS,
    *LIVENESS,
    *BOOKS,
)
