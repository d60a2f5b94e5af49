"""Poses of one arm: degrees and millimetres in the file -> joint values in SI, inside the limits."""

from __future__ import annotations

import math
from dataclasses import dataclass

from arboleda.core.counting import counted
from arboleda.core.model import Joint, Pose

from .document import Document, Place
from .robot_models import TO_SI, millimetres
from .shapes import PoseShape, PositionShape

ROUNDING = 1e-9  # rad or m, far below a motor step


@dataclass(frozen=True, kw_only=True)
class PoseReader:
    """Reads the poses of one arm; problems in a section that cells share name the cell."""

    document: Document
    cell: str
    model: str
    joints: tuple[Joint, ...]

    def home(self, place: Place) -> Pose | None:
        """The home pose; nothing is picked up there, so it has no approach height."""
        q = self.position(place)
        return self.checked("home", q, self._places(place)) if q else None

    def pose(self, place: Place, name: str) -> Pose | None:
        """A pose with its approach height."""
        shape = self.document.read(PoseShape, place)
        q = self._spread(shape, place) if shape else None
        pose = self.checked(name, q, self._places(place)) if q else None
        return self.lifted(pose, shape.approach_mm, place) if pose and shape else None

    def position(self, place: Place) -> tuple[float, ...] | None:
        """Joint values, not yet held against limits: `deg` and `mm` matched to the arm's joints."""
        shape = self.document.read(PositionShape, place)
        return self._spread(shape, place) if shape else None

    def checked(self, name: str, q: tuple[float, ...], places: tuple[Place, ...]) -> Pose | None:
        """The pose, if each joint is inside its limits; `places` says where each value stands."""
        inside = [self._inside(index, q[index], place) for index, place in enumerate(places)]
        return Pose(name=name, q=q) if all(inside) else None

    def lifted(self, pose: Pose, approach_mm: float, place: Place) -> Pose | None:
        """The pose with the point `approach_mm` over it; 0 is no approach."""
        if not approach_mm:
            return pose
        place = (*place, "approach_mm")
        index = next((i for i, joint in enumerate(self.joints) if joint.unit == "m"), None)
        if index is None:
            needs = f"an approach height needs a sliding joint; the {self.model} has none"
            self.problem(place, needs)
            return None
        joint, up = self.joints[index], pose.q[index] - millimetres(approach_mm)
        if up < joint.lower - ROUNDING:
            reach = f"would lift q{index + 1} to {in_file_unit(joint, up)}; allowed: {span(joint)}"
            self.problem(place, reach)
            return None
        above = (*pose.q[:index], max(up, joint.lower), *pose.q[index + 1 :])
        return Pose(name=pose.name, q=pose.q, above=above)

    def mm_fits(self, place: Place, *, needed: bool) -> bool:
        """Whether `mm` is given where the arm has a sliding joint, and only there."""
        given = self.document.has((*place, "mm"))
        slides = any(joint.unit == "m" for joint in self.joints)
        if given and not slides:
            self.problem((*place, "mm"), f"the {self.model} has no sliding joint; delete it")
        if needed and slides and not given:
            self.problem(place, f'the key "mm" is missing: the {self.model} has a sliding joint')
        return slides if given else not (needed and slides)

    def problem(self, place: Place, sentence: str, *, at: Place | None = None) -> None:
        """Keeps a problem, with the cell's name where the section is a shared one."""
        note = "" if place[0] == "cells" else f" (cell {self.cell})"
        self.document.problem(place, sentence + note, at=at)

    def _spread(self, shape: PositionShape, place: Place) -> tuple[float, ...] | None:
        turning = [joint for joint in self.joints if joint.unit == "rad"]
        if len(shape.deg) != len(turning):
            needed = counted(len(turning), "turning joint")
            counts = f"has {counted(len(shape.deg), 'value')}; the {self.model} has {needed}"
            self.problem((*place, "deg"), counts)
            return None
        if not self.mm_fits(place, needed=True):
            return None
        angles, height = iter(shape.deg), millimetres(shape.mm)
        return tuple(TO_SI["deg"](next(angles)) if joint.unit == "rad" else height for joint in self.joints)

    def _places(self, place: Place) -> tuple[Place, ...]:
        numbers = iter(range(len(self.joints)))
        return tuple(
            (*place, "deg", next(numbers)) if joint.unit == "rad" else (*place, "mm") for joint in self.joints
        )

    def _inside(self, index: int, value: float, place: Place) -> bool:
        joint = self.joints[index]
        if not joint.lower <= value <= joint.upper:
            where = f"{in_file_unit(joint, value)} is outside the limits of q{index + 1} ({joint.name})"
            self.problem(place, f"{where}; allowed: {span(joint)}")
        return joint.lower <= value <= joint.upper


def in_file_unit(joint: Joint, value: float) -> str:
    """A joint value as the file gives it: `150 deg` or `80 mm`."""
    return f"{value * 1000:.6g} mm" if joint.unit == "m" else f"{math.degrees(value):.6g} deg"


def span(joint: Joint) -> str:
    """The limits of a joint: `-150 deg to 150 deg`."""
    return f"{in_file_unit(joint, joint.lower)} to {in_file_unit(joint, joint.upper)}"
