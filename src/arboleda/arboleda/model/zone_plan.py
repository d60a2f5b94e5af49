"""Plan of the shared zones on a robot's way: which zones it needs, and on which legs it has to hold them.

A robot of a grid also comes by the nodes between two poses. The zones of a pose at such a node count.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

from arboleda.model.commands import Position
from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import Pose, Workspace


@dataclass(frozen=True, kw_only=True)
class Leg:
    """Leg from one zone-free pose of a way to the next, by index: `zones` are taken before the first move.

    They are held until the work at the end pose is done, since a recovery may start there.
    """

    start: int
    end: int
    zones: frozenset[str]


def plan(space: Workspace, poses: Sequence[Pose], back: Pose | None) -> list[Leg]:
    """The legs of a way over these poses, in order; ConfigError where it does not begin and end zone-free.

    A recovery would bring a part to `back`, if any.
    """
    for pose in (poses[0], poses[-1]):
        if pose.zones:
            raise ConfigError((f"{space.robot.name}: {lying(pose)}, so no way may start or end there",))
    free = [index for index, pose in enumerate(poses) if not pose.zones]
    last_away = max((index for index, pose in enumerate(poses) if pose.name != space.home.name), default=0)
    return [
        Leg(
            start=start,
            end=end,
            zones=_zones(space, poses[start : end + 1], back if start < last_away else None),
        )
        for start, end in pairwise(free)
    ]


def entered(space: Workspace, start: Pose | None, positions: Sequence[Position]) -> frozenset[str]:
    """The zones that a motion gets into: those on its positions and, from a known pose, those it crosses.

    The first of several positions is where the robot is.
    """
    inside = _lying(space, positions[1:] or positions)
    ends = [pose for pose in space.poses if positions[-1] in (pose.q, pose.above)]
    return inside if start is None else inside | _crossed(space, [(start, end) for end in ends])


def passed(space: Workspace, start: Position | None, goal: Position) -> frozenset[str]:
    """The zones between a position and a goal, on the routes of a robot of a grid there and back."""
    there = space.robot.motion.route(start, goal)
    back = () if start is None else space.robot.motion.route(goal, start)
    return _lying(space, {*there, *back} - {start, goal})


def recovery_zones(space: Workspace, start: Pose | None, back: Pose | None) -> frozenset[str]:
    """The zones on the way from `start` to `back` and home; without a start from all poses."""
    goals = (back, space.home) if back else (space.home,)
    starts = space.poses if start is None else (start,)
    moves = [(pose, goal) for pose in starts for goal in goals]
    return _zones(space, goals, back) | _crossed(space, moves)


def _zones(space: Workspace, poses: Sequence[Pose], back: Pose | None) -> frozenset[str]:
    """The zones of poses, of the moves between them, and of a recovery from any of them."""
    recovery = (back, space.home) if back else (space.home,)
    moves = [*pairwise(poses), *combinations(recovery, 2)]
    moves += [(pose, goal) for pose in poses for goal in recovery]
    inside = (pose.zones for pose in (*poses, *recovery))
    halted = [spot for a, b in pairwise(poses) for spot in space.robot.motion.route(a.q, b.q)]
    between = (passed(space, spot, goal.q) for spot in halted for goal in recovery)
    return _crossed(space, moves).union(*inside, *between)


def _crossed(space: Workspace, moves: Sequence[tuple[Pose, Pose]]) -> frozenset[str]:
    ends = [{a.name, b.name} for a, b in moves] if space.crossings else []
    named = (each.zones for each in space.crossings if {each.a, each.b} in ends)
    return frozenset[str]().union(*named, *(passed(space, a.q, b.q) for a, b in moves))


def _lying(space: Workspace, spots: Collection[Position]) -> frozenset[str]:
    """The zones of all poses at, or below, these positions."""
    there = (pose for pose in space.poses if pose.q in spots or pose.above in spots) if spots else ()
    return frozenset[str]().union(*(pose.zones for pose in there))


def lying(pose: Pose) -> str:
    """The zones in which a pose lies, for a sentence."""
    return f"{pose.name} lies in zone {', '.join(sorted(pose.zones))}"
