"""Joint of a URDF that moves an arm: its limits and its speed, checked."""

from __future__ import annotations

from dataclasses import dataclass

from .problems import Problems
from .robot_models import FULL_TURN_RAD
from .urdf_values import number, numbers
from .xml_marks import Tag

MOVING = ("revolute", "continuous", "prismatic")
FOLLOWS = "it follows another joint, and here every joint of the arm has a motor of its own; make it fixed"


@dataclass(frozen=True, kw_only=True)
class Axis:
    """A joint that moves, as a file describes it; None for values that it leaves open."""

    name: str
    type: str
    lower: float
    upper: float
    speed: float | None
    acceleration: float | None = None
    step: float | None = None
    pinion_radius_m: float | None = None


def axis(problems: Problems, joint: Tag) -> Axis | None:
    """The joint, if a motor can drive it; None, with the problems kept, if not."""
    name, kind = joint.attributes["name"], joint.attributes["type"]
    if mimic := joint.first("mimic"):
        problems.keep(mimic.mark, f"the joint {name} has <mimic>: {FOLLOWS}")
    _check_direction(problems, joint)
    limit = joint.first("limit")
    if limit is None and kind != "continuous":
        problems.keep(joint.mark, f"the joint {name} needs <limit> with lower and upper")
        return None
    limits = _limits(problems, joint, limit) if limit and kind != "continuous" else None
    lower, upper = limits or (-FULL_TURN_RAD, FULL_TURN_RAD)
    return Axis(name=name, type=kind, lower=lower, upper=upper, speed=_speed(problems, joint, limit))


def _check_direction(problems: Problems, joint: Tag) -> None:
    tag = joint.first("axis")
    if tag is not None and numbers(problems, tag, "xyz", 3) == (0.0, 0.0, 0.0):
        name = joint.attributes["name"]
        problems.keep(tag.mark, f"the axis of the joint {name} is 0 0 0; it must point somewhere")


def _limits(problems: Problems, joint: Tag, limit: Tag) -> tuple[float, float] | None:
    """Both ends of the joint; None, with the problem kept, if no motor can have them."""
    name = joint.attributes["name"]
    lower, upper = (number(problems, limit, key, 0.0) for key in ("lower", "upper"))
    if lower is None or upper is None:
        return None
    if lower >= upper:
        rule = f"lower of the joint {name} must be less than upper"
        problems.keep(limit.mark, f"{rule}; is {lower:g}, {upper:g}")
        return None
    if not lower <= 0 <= upper:
        rule = f"the limits of the joint {name} must have 0 inside, where homing ends"
        is_ = f"they are {lower:g} to {upper:g} {_unit(joint)}"
        end = "lower" if lower > 0 else "upper"
        problems.keep(limit.mark, f'{rule}; {is_}; write {end}="0" in a copy of the file')
        return None
    return lower, upper


def _speed(problems: Problems, joint: Tag, limit: Tag | None) -> float | None:
    """The speed; None where the file has none. Some exporters write 0 for none."""
    speed = number(problems, limit, "velocity", 0.0) if limit else None
    if speed is not None and speed < 0:
        rule = f"velocity of the joint {joint.attributes['name']} must be more than 0 {_unit(joint)}/s"
        problems.keep((limit or joint).mark, f"{rule}, is {speed:g}")
    return speed or None


def _unit(joint: Tag) -> str:
    return "m" if joint.attributes["type"] == "prismatic" else "rad"
