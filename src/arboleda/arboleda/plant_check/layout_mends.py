"""Ends of warnings about a layout: the nearest number that would be right, or what to move and how far."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from arboleda.geometry import kinematics
from arboleda.geometry.bodies import Body, tool_chain
from arboleda.kinds.arm import Arm
from arboleda.kinds.mobile import Mobile
from arboleda.model.plant_model import Pose

Outline = Sequence[Sequence[float]]  # counterclockwise corners of a convex shape on the floor
UPRIGHT = 1 - 1e-6


def moved_grid(mobile: Mobile, shifts: Sequence[Sequence[float]], near_m: float) -> str:
    """The origin of a grid at which all its ends of paths are under their pick-ups, by how far they are off.

    Where no origin is right for all of them, the pick-ups have to be taught.
    """
    x, y = (sum(each[axis] for each in shifts) / len(shifts) for axis in (0, 1))
    if any(math.dist(each[:2], (x, y)) > near_m for each in shifts):
        return "; teach the pick-ups of these paths anew"
    origin = mobile.grid.origin
    there = ", ".join(f"{round(each, 3) + 0.0:.3f}" for each in (origin.x + x, origin.y + y))  # no -0.000
    return f"; write origin_m: [{there}] of its grid"


def raised(arm: Arm, body: Body, pose: Pose, by_m: float) -> str:
    """The height of an arm's only slide that brings its tool higher by so much; else how far to go."""
    frames = kinematics.place(body, pose.joints)
    slides = [link for link in tool_chain(body) if link["moves"] and link["moves"]["type"] == "slide"]
    if len(slides) == 1:
        moves = slides[0]["moves"]
        up, joint = kinematics.upright(frames[slides[0]["link"]], moves["axis"]), arm.joints[moves["index"]]
        height_m = pose.joints[moves["index"]] + by_m * math.copysign(1, up)
        if abs(up) > UPRIGHT and joint.lower <= height_m <= joint.upper:
            return f"; write mm: {height_m * 1000:.0f}"
    far = f"{abs(by_m) * 1000:.0f}"
    return f"; teach it {far} mm higher" if by_m > 0 else f"; teach it {far} mm lower"


def apart(one: Outline, other: Outline) -> str:
    """The distance by which one of two shapes that share floor has to be moved, so that they share none."""
    least_m = min(_shared(edge, one, other) for outline in (one, other) for edge in edges(outline))
    return f"; move one of them by {math.ceil(least_m * 1000)} mm"


def edges(outline: Outline) -> Iterator[tuple[Sequence[float], Sequence[float]]]:
    return zip(outline, [*outline[1:], outline[0]], strict=True)


def _shared(edge: tuple[Sequence[float], Sequence[float]], one: Outline, other: Outline) -> float:
    """The length (m) that two shapes share across an edge of either."""
    (x0, y0), (x1, y1) = edge
    long = math.hypot(x1 - x0, y1 - y0)
    across = ((y1 - y0) / long, (x0 - x1) / long)
    of_one, of_other = ([x * across[0] + y * across[1] for x, y in outline] for outline in (one, other))
    return min(max(of_one) - min(of_other), max(of_other) - min(of_one))
