"""Open motion or process of a board, and whether telemetry ends it.

The engine decides whether the work is done. This module decides how long the board needs heartbeats.
"""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.model.commands import Motion, Position, Work
from arboleda.model.facts import Facts
from arboleda.model.messages import MotionState
from arboleda.model.plant_model import Evidence, Robot

from .payloads import Telemetry

LINGER_S = 1.0  # a board drives on for so long without heartbeats


@dataclass(kw_only=True)
class OpenMotion:
    """Work that was sent as `seq`; `stopping` once a halt or a stop followed.

    A board that names no command may report rest of an earlier move, or before this command has reached it.
    So it gets heartbeats until it has reported rest for LINGER_S. `ending` is True meanwhile.
    """

    robot: Robot
    command: Work
    seq: int
    stopping: bool = False
    moved: bool = False
    _still_since: float | None = None

    @property
    def ending(self) -> bool:
        """True if the next telemetry may end the motion even if it repeats the last."""
        return self._still_since is not None

    def ended(
        self,
        at: float,
        telemetry: Telemetry,
        q: tuple[float, ...] | None,
        seqs: frozenset[int],
        facts: Facts | None = None,
    ) -> bool:
        """True if telemetry heard `at` ends this work.

        `q` are joints in SI units, `seqs` the commands that the telemetry ends, `facts` those of a device.
        """
        if self.seq in seqs:
            return True
        if telemetry.state is MotionState.MOVING:
            self.moved, self._still_since = True, None
            return False
        if self.robot.evidence is Evidence.IDS:
            return self.stopping
        if not (self.stopping or self.moved or self._reached(telemetry.node if q is None else q, facts)):
            return False
        self._still_since = at if self._still_since is None else self._still_since
        return at >= self._still_since + LINGER_S

    def _reached(self, position: Position | None, facts: Facts | None) -> bool:
        if self.robot.evidence is not Evidence.JOINTS:
            return False
        if self.command.sets:
            return set(self.command.sets) <= set(facts or ())
        if position is None or not isinstance(self.command, Motion) or not self.command.way:
            return False
        return self.robot.motion.stands_at(position, self.command.way[-1])
