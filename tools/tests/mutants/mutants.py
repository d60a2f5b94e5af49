"""Every mutant: one for each invariant of the simulator."""

from __future__ import annotations

from .bodies import BODIES
from .cells import CELLS
from .leaders import LEADERS
from .operation import OPERATION
from .protocol import PROTOCOL
from .restarts import RESTARTS
from .teaching import TEACHING

MUTANTS = (*BODIES, *PROTOCOL, *CELLS, *OPERATION, *RESTARTS, *LEADERS, *TEACHING)
