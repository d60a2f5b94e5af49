"""An open motion command: when does what a board says end it?

The judge of the core decides what was achieved; this only decides how long the board needs beats.
"""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.core.messages import Command, FollowPath, MoveJoints
from arboleda.core.model import Arm, Evidence, MotionState, Robot

from .payloads import Telemetry


@dataclass(kw_only=True)
class Motion:
    """A motion command that was sent as `seq`; `stopping` once a halt or a stop followed it."""

    robot: Robot
    command: Command
    seq: int
    stopping: bool = False
    moved: bool = False

    def ended(self, said: Telemetry, q: tuple[float, ...] | None, seqs: frozenset[int]) -> bool:
        """Whether telemetry (its joints `q` in SI, the command `seqs` it ends) ends this motion."""
        if self.seq in seqs:
            return True
        if said.state is MotionState.MOVING:
            self.moved = True
            return False
        return self.stopping or self._proven_by(said, q)

    def _proven_by(self, said: Telemetry, q: tuple[float, ...] | None) -> bool:
        """Whether a robot that stands still and names no command has ended this one."""
        if self.robot.evidence is Evidence.IDS:
            return False
        return self.moved or (self.robot.evidence is Evidence.JOINTS and self._reached(said, q))

    def _reached(self, said: Telemetry, q: tuple[float, ...] | None) -> bool:
        if isinstance(self.command, FollowPath):
            return said.node == self.command.nodes[-1]
        if isinstance(self.command, MoveJoints) and isinstance(self.robot, Arm) and q is not None:
            return self.robot.reached(q, self.robot.quantised(self.command.q))
        return False
