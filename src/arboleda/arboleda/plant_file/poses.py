"""Poses of one arm: degrees and millimetres in the file -> joint values in SI, inside the limits."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import count, repeat

from arboleda.kinds.joints import Joint
from arboleda.model.counting import counted
from arboleda.model.plant_model import Pose
from arboleda.model.sentence import Phrase, Sentence

from .document import Document, Place
from .robot_models import TO_SI, millimetres
from .shapes import NUMBER, NUMBERS, PoseShape, PositionShape

HOME = Phrase("pose.home", "home")
PICKUP = Phrase("pose.pickup", "pick-up")
PICKUP_AT = Phrase("pose.pickup_at", "pick-up {exit}")
STATION = Phrase("pose.station", "station {number}")
ROUNDING = 1e-9  # rad or m, far below a motor step


@dataclass(frozen=True, kw_only=True)
class PoseReader:
    """Reads the poses of one arm. A problem in a section that cells share names the cell."""

    document: Document
    cell: str
    model: str
    joints: tuple[Joint, ...]

    def home(self, place: Place) -> Pose | None:
        """The home pose; nothing is picked up there, so it has no approach height."""
        q = self.position(place)
        return self.checked(HOME(), q, self._places(place)) if q else None

    def pose(self, place: Place, title: Sentence) -> Pose | None:
        """A pose with its approach height."""
        shape = self.document.read(PoseShape, place)
        q = self._spread(shape, place) if shape else None
        pose = self.checked(title, q, self._places(place)) if q else None
        return self.lifted(pose, shape.approach_mm, place) if pose and shape else None

    def position(self, place: Place) -> tuple[float, ...] | None:
        """The values of all joints, from `deg` and `mm`, not yet checked against limits."""
        shape = self.document.read(PositionShape, place)
        return self._spread(shape, place) if shape else None

    def checked(self, title: Sentence, q: tuple[float, ...], places: tuple[Place, ...]) -> Pose | None:
        """The pose, if each joint is inside its limits; `places` are those of the values in the file."""
        inside = [self._inside(index, q[index], place) for index, place in enumerate(places)]
        return Pose(name=str(title), title=title, q=q) if all(inside) else None

    def lifted(self, pose: Pose, approach_mm: float, place: Place) -> Pose | None:
        """The pose with the point `approach_mm` over it; 0 is no approach."""
        if not approach_mm:
            return pose
        place = (*place, "approach_mm")
        index = self._lifting(place)
        if index is None:
            return None
        joint = self.joints[index]
        q = pose.joints
        up = q[index] + joint.up * millimetres(approach_mm)
        if not joint.lower - ROUNDING <= up <= joint.upper + ROUNDING:
            reach = f"would lift q{index + 1} to {in_file_unit(joint, up)}; allowed: {span(joint)}"
            self.problem(place, reach)
            return None
        above = (*q[:index], min(max(up, joint.lower), joint.upper), *q[index + 1 :])
        return replace(pose, above=above)

    def heights(self, place: Place, *, needed: bool) -> tuple[float, ...] | None:
        """The values of `mm` in m, one for each sliding joint; empty where `mm` may lack and does."""
        slides = [joint for joint in self.joints if joint.unit == "m"]
        place = (*place, "mm")
        if not self.document.has(place):
            if needed and slides:
                joints = "a sliding joint" if len(slides) == 1 else counted(len(slides), "sliding joint")
                self.problem(place[:-1], f'the key "mm" is missing: the {self.model} has {joints}')
            return None if needed and slides else ()
        if not slides:
            self.problem(place, f"the {self.model} has no sliding joint; delete it")
            return None
        return self._listed(place, len(slides))

    def problem(self, place: Place, sentence: str, *, at: Place | None = None) -> None:
        """Keep a problem, with the cell's name if the section is a shared one."""
        note = "" if place[0] == "cells" else f" (cell {self.cell})"
        self.document.problem(place, sentence + note, at=at)

    def places_of_mm(self, place: Place) -> Iterator[Place]:
        """The place in the file of each value of `mm`, from the base outwards."""
        place = (*place, "mm")
        if isinstance(self.document.value(place), list):
            return ((*place, index) for index in count())
        return repeat(place)

    def _listed(self, place: Place, wanted: int) -> tuple[float, ...] | None:
        """One number for each sliding joint; a single one needs no list."""
        if not isinstance(self.document.value(place), list) and wanted == 1:
            value = self.document.read_plain(NUMBER, place)
            return None if value is None else (millimetres(value),)
        values = self.document.read_plain(NUMBERS, place)
        if values is not None and len(values) != wanted:
            has, needed = counted(len(values), "value"), counted(wanted, "sliding joint")
            self.problem(place, f"has {has}; the {self.model} has {needed}")
            return None
        return None if values is None else tuple(map(millimetres, values))

    def _lifting(self, place: Place) -> int | None:
        """The joint that lifts the tool: the last one that slides up and down."""
        slides = [index for index, joint in enumerate(self.joints) if joint.unit == "m"]
        upright = [index for index in slides if self.joints[index].up]
        if not slides:
            self.problem(place, f"an approach height needs a sliding joint; the {self.model} has none")
        elif not upright:
            none = f"the {self.model} has none that always does"
            self.problem(place, f"an approach height needs a joint that slides up and down; {none}")
        return upright[-1] if upright else None

    def _spread(self, shape: PositionShape, place: Place) -> tuple[float, ...] | None:
        turning = [joint for joint in self.joints if joint.unit == "rad"]
        if turning and not self.document.has((*place, "deg")):
            self.problem(place, 'the key "deg" is missing')
            return None
        if len(shape.deg) != len(turning):
            needed = counted(len(turning), "turning joint") if turning else "no turning joint"
            counts = f"has {counted(len(shape.deg), 'value')}; the {self.model} has {needed}"
            self.problem((*place, "deg"), counts)
            return None
        heights = self.heights(place, needed=True)
        if heights is None:
            return None
        angles, slides = iter(shape.deg), iter(heights)
        return tuple(
            TO_SI["deg"](next(angles)) if joint.unit == "rad" else next(slides) for joint in self.joints
        )

    def _places(self, place: Place) -> tuple[Place, ...]:
        numbers, heights = count(), self.places_of_mm(place)
        return tuple(
            (*place, "deg", next(numbers)) if joint.unit == "rad" else next(heights) for joint in self.joints
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
