"""A gripper behind an action of ros2_control: how wide it is, and whether a part is between its fingers.

Controllers end a goal that closes on a part as a success or as a failure, by how they are set. So a part is
what fingers show that have moved, and rest before the width that they were told.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from arboleda.drivers import Command, Device, Robot, VerbCommand, Work
from arboleda_drivers.ros_action.events import GoalResult, Measurement, Status
from arboleda_drivers.ros_action.joints import Joints
from arboleda_drivers.ros_action.machine import Machine
from arboleda_drivers.ros_action.mover import NoGoal, failure

from .settings import Settings

STILL = 0.25  # share of the tolerance, within the time that proves rest


@dataclass(frozen=True, kw_only=True)
class Width:
    """Goal for the width of the fingers. `from_mm`: their width before; `grips`: a part stops them earlier.

    `compared`: the plant compares what it has led to. It does so for work, not for a switch, of which
    it hears no end but the fact.
    """

    joint: str
    position: float
    effort: float
    width_mm: float
    from_mm: float
    grips: bool
    compared: bool


class GripperMover:
    """Gripper, measured by the joint state of its fingers."""

    replaces = True  # letting go must not wait for a grip that never ends

    def __init__(self, device: Device, settings: Settings) -> None:
        self.name = device.name
        self._settings, self._kind = settings, device.kind
        still = abs(settings.units_per_mm) * settings.tolerance_mm * STILL
        self._joint = Joints((settings.joint,), settings.joint_states, rest=still)
        self._goal_mm: float | None = None  # the width of the last goal
        self._gripped: bool | None = None  # None: unknown
        self._held_mm = 0.0  # width of the part

    @property
    def width_mm(self) -> float:
        assert self._joint.q is not None
        return self._settings.width(self._joint.q[0])

    def see(self, now: float, measurement: Measurement) -> bool:
        if not self._joint.see(now, measurement):
            return False
        if self._gripped and not self._near(self._held_mm):
            self._gripped = False  # it slipped out, or the fingers were moved apart
        return True

    def missing(self, now: float) -> str:
        return self._joint.missing(now)

    def goals(self, command: Command) -> tuple[Width, ...]:
        if not isinstance(command, VerbCommand):
            raise NoGoal(f"a gripper has no word for {type(command).__name__}")
        values, grips = dict(command.values), ("gripped", True) in command.sets
        width_mm = float(values.get("width_mm", 0.0 if grips else self._settings.width_mm))
        self._goal_mm = width_mm
        goal = Width(
            joint=self._settings.joint,
            position=self._settings.position(width_mm),
            effort=float(values.get("force_n", 0.0)),
            width_mm=width_mm,
            from_mm=math.inf if self._gripped else self.width_mm,
            grips=grips,
            compared=isinstance(command, Work),
        )
        return (goal,)

    def has_measured_since(self, at: float) -> bool:
        return self._joint.measured_at > at

    def is_at(self, goal: Width) -> bool:
        """True if the fingers are at the goal; ones that close on a part are there once they rest on it."""
        if goal.grips:
            return self._joint.rest.holds(self._joint.measured_at) and self._holds(goal)
        return self._near(goal.width_mm)

    def rests(self, now: float, since: float = 0.0) -> bool:
        return self._joint.rest.holds(now, since)

    def failure(self, end: GoalResult, goal: Width) -> str:
        if end.stalled and end.status in (Status.SUCCEEDED, Status.ABORTED):
            return "" if goal.grips else "stalled"  # the fingers' position shows if they have a part
        return failure(end, {})

    def objection(self, goal: Width) -> str:
        if goal.grips:
            return "" if self._holds(goal) else "nothing_gripped"
        return "" if goal.compared or self._near(goal.width_mm) else "width_not_reached"

    def settle(self, goal: Width | None) -> None:
        if goal is None:
            self._gripped = None
        elif goal.grips:
            self._gripped, self._held_mm = self._holds(goal), self.width_mm
        else:
            self._gripped = False if self._near(goal.width_mm) else None

    def shows(self, *, busy: bool) -> dict[str, Any]:
        """The facts for a report; `gripped` is left out while the fingers may still move."""
        known: dict[str, Any] = {"width_mm": self._shown_mm()}
        if not busy and self._gripped is not None:
            known["gripped"] = self._gripped
        read = ((name, type.read(known[name])) for name, type in self._kind.facts.items() if name in known)
        return {"facts": tuple((name, value) for name, value in read if value is not None)}

    def _near(self, width_mm: float) -> bool:
        return abs(self.width_mm - width_mm) <= self._settings.tolerance_mm

    def _holds(self, goal: Width) -> bool:
        """True if the fingers have moved and then stopped at a width that a part between them may have."""
        width_mm, tolerance_mm = self.width_mm, self._settings.tolerance_mm
        between = goal.width_mm + tolerance_mm < width_mm < goal.from_mm - tolerance_mm
        return between and self._settings.narrowest_mm <= width_mm <= self._settings.widest

    def _shown_mm(self) -> float:
        """The width for reports, mm: the one commanded if the fingers are near it, else as measured."""
        if self._goal_mm is not None and self._near(self._goal_mm):
            return self._goal_mm
        return round(self.width_mm, 1)


def machine(devices: Sequence[Robot], settings: Settings) -> Machine:
    """The machine of one gripper; raises ValueError for other devices."""
    if len(devices) != 1 or not isinstance(devices[0], Device):
        raise ValueError("a gripper controller moves one gripper, a device of a declared kind")
    return Machine(GripperMover(devices[0], settings), settings.action)
