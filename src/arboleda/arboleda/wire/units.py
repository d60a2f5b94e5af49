"""Degrees on the wire, SI inside: the only place that converts."""

from __future__ import annotations

import math

from arboleda.kinds.arm import Joint


def to_wire(joint: Joint, value: float) -> float:
    """rad, or m of a rack, to degrees of the joint or of its pinion."""
    return math.degrees(value / (joint.pinion_radius_m or 1.0))


def from_wire(joint: Joint, degrees: float) -> float:
    """Degrees of the joint or of its pinion to rad, or m of a rack."""
    return math.radians(degrees) * (joint.pinion_radius_m or 1.0)
