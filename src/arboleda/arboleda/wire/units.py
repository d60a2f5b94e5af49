"""Conversion of units between the wire (degrees) and the plant (SI); nothing else converts."""

from __future__ import annotations

import math

from arboleda.kinds.joints import Joint


def to_wire(joint: Joint, value: float) -> float:
    """Degrees of the joint or of its pinion, from rad, or m of a rack."""
    return math.degrees(value / (joint.pinion_radius_m or 1.0))


def from_wire(joint: Joint, degrees: float) -> float:
    """Rad, or m of a rack, from degrees of the joint or of its pinion."""
    return math.radians(degrees) * (joint.pinion_radius_m or 1.0)
