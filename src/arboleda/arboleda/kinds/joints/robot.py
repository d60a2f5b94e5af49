"""Robot of joints: its position, its commands, and what its reports can say."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from operator import attrgetter
from typing import ClassVar

from arboleda.model.commands import Position
from arboleda.model.counting import counted
from arboleda.model.messages import Report
from arboleda.model.plant_model import JointStates, Robot

from .commands import MoveJoints
from .joint import Joint
from .motion import JointMotion


@dataclass(frozen=True, kw_only=True)
class Description:
    """Model given by the plant: its URDF without a prefix, and the assumptions made on it."""

    urdf: str
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Jointed(Robot):
    """Robot whose position is a number for each of its joints.

    `tolerance` per joint overrides the default of half a motor step + 1e-5. `model` is that of its drawing,
    empty where it has none.
    """

    kind_name: str = "axes"
    joints: tuple[Joint, ...] = ()
    model: str = ""
    description: Description | None = None  # None: the model comes with arboleda_description
    tolerance: tuple[float, ...] | None = None
    position_key: ClassVar[str | None] = "q"
    published_by: ClassVar[str] = "name"  # the attribute whose text names its joints in public
    unsaid: ClassVar[tuple[str, ...]] = ("node", "effector", "piece")  # what no report of it has

    @cached_property
    def joint_states(self) -> JointStates:
        twin: str = getattr(self, self.published_by)
        names = tuple(f"{twin}_{joint.name}" for joint in self.joints)
        return JointStates(twin=twin, joints=names, measured=attrgetter("q"))

    @property
    def units(self) -> list[str]:
        return [joint.unit for joint in self.joints]

    def objection(self, report: Report) -> str | None:
        for key in self.unsaid:
            if getattr(report, key) is not None:
                return f"{key} was said; {self.name} is a robot of joints and has none"
        if report.q is not None and len(report.q) != len(self.joints):
            has = f"{self.name} has {counted(len(self.joints), 'joint')}"
            return f"q has {counted(len(report.q), 'value')}; {has}"
        return None

    @cached_property
    def motion(self) -> JointMotion:
        held = tuple(joint.step / 2 + 1e-5 for joint in self.joints)
        return JointMotion(self.joints, self.tolerance or held)

    def go(self, *, id: str, way: Sequence[Position]) -> MoveJoints:
        goal = way[-1]
        assert isinstance(goal, tuple)
        return MoveJoints(id=id, robot=self.name, q=goal)

    @cached_property
    def reference(self) -> tuple[float, ...]:
        """The joints at the end of the homing routine, from which the counters begin."""
        return (0.0,) * len(self.joints)

    def at_rate(self, rate: float) -> Jointed:
        """The same robot at `rate` times its speed, and its square for accelerations: ramps keep their
        shape."""
        return replace(self, joints=tuple(joint.at_rate(rate) for joint in self.joints))
