"""What a robot can say: a mobile has no effector, an arm stands on no node."""

from __future__ import annotations

from .counting import counted
from .messages import Report
from .model import Arm, Mobile, Robot


def objection(robot: Robot, report: Report) -> str | None:
    """Why this robot cannot have said this; None where it can."""
    if isinstance(robot, Arm):
        return _of_arm(robot, report)
    return _of_mobile(robot, report) if isinstance(robot, Mobile) else None


def _of_arm(arm: Arm, report: Report) -> str | None:
    if report.node is not None:
        return f"node is {report.node}; {arm.name} is an arm and stands on no node"
    if report.q is not None and len(report.q) != len(arm.joints):
        return f"q has {counted(len(report.q), 'value')}; {arm.name} has {counted(len(arm.joints), 'joint')}"
    return None


def _of_mobile(mobile: Mobile, report: Report) -> str | None:
    for key in ("q", "effector", "piece"):
        if getattr(report, key) is not None:
            return f"{key} was said; {mobile.name} is a mobile robot and has none"
    if report.node is not None and not 0 <= report.node < mobile.grid.size:
        return f"node is {report.node}; {mobile.name} knows {mobile.grid.size} nodes"
    return None
