"""Every mutant: one for each invariant of the simulator."""

from __future__ import annotations

from .bodies import BODIES
from .cells import CELLS
from .leaders import LEADERS
from .protocol import PROTOCOL
from .restarts import RESTARTS
from .told import TOLD

MUTANTS = (*BODIES, *PROTOCOL, *CELLS, *TOLD, *RESTARTS, *LEADERS)
