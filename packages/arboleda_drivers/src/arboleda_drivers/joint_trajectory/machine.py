"""Robot of joints behind a joint trajectory controller: its goals, and the measured joints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from arboleda.drivers import Command, Jointed, MoveJoints, Robot
from arboleda_drivers.ros_action.events import GoalResult, Measurement
from arboleda_drivers.ros_action.joints import Joints
from arboleda_drivers.ros_action.machine import Machine
from arboleda_drivers.ros_action.mover import NoGoal, failure

from .settings import Settings

ERRORS = {
    -1: "invalid_goal",
    -2: "invalid_joints",
    -3: "old_time_stamp",
    -4: "path_tolerance_violated",
    -5: "goal_tolerance_violated",
}
"""The word for the plant of each error_code of the controller."""


@dataclass(frozen=True, kw_only=True)
class Trajectory:
    """Goal of one point, at which the arm comes to rest."""

    joints: tuple[str, ...]
    q: tuple[float, ...]
    duration_s: float


class ArmMover:
    """Robot of joints, measured by its joint states."""

    replaces = False

    def __init__(self, arm: Jointed, settings: Settings) -> None:
        self.name = arm.name
        self._arm, self._settings = arm, settings
        self._joints = Joints(settings.joint_names(arm), settings.joint_states)

    def see(self, now: float, measurement: Measurement) -> bool:
        return self._joints.see(now, measurement)

    def missing(self, now: float) -> str:
        return self._joints.missing(now)

    def goals(self, command: Command) -> tuple[Trajectory, ...]:
        if not isinstance(command, MoveJoints):
            raise NoGoal(f"a joint trajectory controller has no word for {type(command).__name__}")
        assert self._joints.q is not None
        duration_s = self._settings.duration_s(self._arm, self._joints.q, command.q)
        return (Trajectory(joints=self._joints.names, q=command.q, duration_s=duration_s),)

    def has_measured_since(self, at: float) -> bool:
        return self._joints.measured_at > at

    def is_at(self, goal: Trajectory) -> bool:
        return self._joints.q is not None and self._arm.motion.stands_at(self._joints.q, goal.q)

    def rests(self, now: float, since: float = 0.0) -> bool:
        return self._joints.rest.holds(now, since)

    def failure(self, end: GoalResult, goal: Trajectory) -> str:
        return failure(end, ERRORS)

    def objection(self, goal: Trajectory) -> str:
        return ""

    def settle(self, goal: Trajectory | None) -> None:
        """Does nothing: an arm keeps no state beyond its goal."""

    def shows(self, *, busy: bool) -> dict[str, Any]:
        return {"q": self._joints.q}


def machine(devices: Sequence[Robot], settings: Settings) -> Machine:
    """The machine of one robot of joints; raises ValueError for other devices."""
    if len(devices) != 1 or not isinstance(devices[0], Jointed):
        raise ValueError("a joint trajectory controller moves one robot of joints")
    return Machine(ArmMover(devices[0], settings), settings.action, settings.health)
