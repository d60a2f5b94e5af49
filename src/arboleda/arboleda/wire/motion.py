"""An open motion command: when does what a board says end it?

The judge of the core decides what was achieved; this only decides how long the board needs beats.
"""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.core.commands import Command
from arboleda.core.model import Evidence, MotionState, Robot
from arboleda.kinds.arm import Arm, MoveJoints
from arboleda.kinds.mobile import FollowPath

from .payloads import Telemetry

LINGER_S = 1.0  # as long as a board drives on without beats; what it says may be of before this command


@dataclass(kw_only=True)
class OpenMotion:
    """A motion command that was sent as `seq`; `stopping` once a halt or a stop followed it.

    A board that names no command may say that it stands still because an earlier move has ended, or before
    this one has reached it. So it gets beats until it has said so for LINGER_S: `ending` meanwhile.
    """

    robot: Robot
    command: Command
    seq: int
    stopping: bool = False
    moved: bool = False
    _still_since: float | None = None

    @property
    def ending(self) -> bool:
        """Whether the next telemetry may end it though it repeats the last."""
        return self._still_since is not None

    def ended(self, at: float, said: Telemetry, q: tuple[float, ...] | None, seqs: frozenset[int]) -> bool:
        """Whether telemetry heard `at` (joints `q` in SI, the command `seqs` it ends) ends this motion."""
        if self.seq in seqs:
            return True
        if said.state is MotionState.MOVING:
            self.moved, self._still_since = True, None
            return False
        if self.robot.evidence is Evidence.IDS:
            return self.stopping
        if not (self.stopping or self.moved or self._reached(said, q)):
            return False
        self._still_since = at if self._still_since is None else self._still_since
        return at >= self._still_since + LINGER_S

    def _reached(self, said: Telemetry, q: tuple[float, ...] | None) -> bool:
        if self.robot.evidence is not Evidence.JOINTS:
            return False
        if isinstance(self.command, FollowPath):
            return said.node == self.command.nodes[-1]
        if isinstance(self.command, MoveJoints) and isinstance(self.robot, Arm) and q is not None:
            return self.robot.reached(q, self.robot.quantised(self.command.q))
        return False
