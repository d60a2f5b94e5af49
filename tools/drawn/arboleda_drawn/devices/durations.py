"""Durations of drawn steps where nothing goes wrong, with room to spare."""

from __future__ import annotations

from collections.abc import Mapping

from .layout import Layout
from .steps import (
    Ask,
    Choose,
    Follow,
    Go,
    Home,
    Parallel,
    Repeat,
    Run,
    Step,
    Tell,
    Tour,
    Using,
    Visit,
    Wait,
    children,
)

ROOM, LEAST_S, LONGEST_S = 3.0, 5.0, 4000.0
DRIVE_S = 40.0
USUAL_S = {Ask: 8.0, Go: 6.0, Home: 6.0, Visit: 6.0, Tour: 12.0, Follow: 12.0}


def longest_s(step: Step, layout: Layout) -> float:
    """Seconds for a timeout around a step: it may wait for people, zones and shared devices."""
    return min(round(_takes_s(step, layout) * ROOM + LEAST_S, 1), LONGEST_S)


def _takes_s(step: Step, layout: Layout) -> float:
    inner = sum(_takes_s(each, layout) for each in children(step))
    shared = layout.shared_roles
    role = getattr(step, "role", "")
    if isinstance(step, Using) or role in shared:
        return LONGEST_S
    if isinstance(step, Repeat):
        return inner * step.times
    if isinstance(step, Tell):
        return layout.device(step.role).kind.verb(step.verb).takes_s + 1.0
    if isinstance(step, Ask):
        return step.at_most_s
    if isinstance(step, Go | Home | Visit | Tour | Follow):
        return inner + (LONGEST_S if layout.robot(step.role).doors else DRIVE_S)
    return inner + (step.seconds if isinstance(step, Wait) else 0.5)


def usual_s(step: Step, layout: Layout, others: Mapping[str, float]) -> float:
    """Seconds that a step takes as a rule; `others` are those of recipes that it may run."""
    inner = [usual_s(each, layout, others) for each in children(step)]
    if isinstance(step, Tell):
        return layout.device(step.role).kind.verb(step.verb).takes_s
    if isinstance(step, Repeat):
        return sum(inner) * step.times
    if isinstance(step, Choose | Parallel):
        return max(inner)
    if isinstance(step, Run):
        return others[step.recipe]
    return sum(inner) + (step.seconds if isinstance(step, Wait) else USUAL_S.get(type(step), 0.0))
