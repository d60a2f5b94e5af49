"""Kinds of devices in Python that come with Arboleda, beside those of packages and of a plant's files."""

from __future__ import annotations

from arboleda.kinds import MovingKind, WrittenKind
from arboleda.kinds.shipped import SHIPPED

from .python_uses import KindInPython
from .robot_kind import RobotKind
from .robots import arm_device, mobile_device, person_device

ROBOTS = (
    RobotKind(name="arm", read=arm_device, goes=True, has_twin=True),
    RobotKind(name="mobile", read=mobile_device, goes=True),
    RobotKind(name="person", read=person_device),
)
COME_WITH_IT: dict[str, KindInPython] = {each.name: each for each in (*ROBOTS, *SHIPPED)}
RESERVED = tuple(each.name for each in ROBOTS)  # names that no kind of one's own may have
IN_PYTHON = (WrittenKind, MovingKind, RobotKind)
