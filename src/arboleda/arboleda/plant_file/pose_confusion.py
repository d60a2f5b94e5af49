"""Poses that a robot cannot tell apart: it may stop at one pose and count as standing at the other.

An arm counts as standing at a pose within its tolerance, and may stop that far from its goal. So two poses
that are no further apart than twice the tolerance, in every joint, look the same.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, permutations, product

from arboleda.model.commands import Position
from arboleda.model.plant_model import Crossing, Pose, Workspace

WHY = "in every joint they are within twice the arm's tolerance of each other, so it cannot tell them apart"
Pair = frozenset[str]  # of names of poses


@dataclass(frozen=True, kw_only=True)
class PoseConfusion:
    """The reason why a zone cannot have the pose that is `named`, or the move between the two that are."""

    zone: str
    named: tuple[str, ...]
    sentence: str


def alike_crossings(space: Workspace) -> tuple[Crossing, ...]:
    """The crossings of moves. A move crosses all zones that it would cross between poses that look alike."""
    crossed = {frozenset({each.a, each.b}): each.zones for each in space.crossings}
    while (grown := _grown(space, crossed)) != crossed:
        crossed = grown
    rows = sorted((tuple(sorted(pair)), zones) for pair, zones in crossed.items())
    return tuple(Crossing(a=a, b=b, zones=zones) for (a, b), zones in rows)


def confusions(space: Workspace) -> list[PoseConfusion]:
    """The poses and moves after which nobody knows whether the robot is in a zone."""
    return list(_at_reference(space)) or list(_between_poses(space))


def _between_poses(space: Workspace) -> Iterator[PoseConfusion]:
    for a, b in _alike(space):
        for inside, outside in permutations((a, b)):
            for zone in sorted(inside.zones - outside.zones):
                what = f"{inside.name} lies in the zone and {outside.name} does not"
                yield PoseConfusion(zone=zone, named=(inside.name,), sentence=f"{what}; {WHY}")
        for zone in sorted(_across(space, a, b)):
            what = f"a move between {a.name} and {b.name} crosses the zone"
            yield PoseConfusion(zone=zone, named=(a.name, b.name), sentence=f"{what}; {WHY}")


def _at_reference(space: Workspace) -> Iterator[PoseConfusion]:
    """The poses in zones that look like the reference: homing ends there, outside all zones."""
    reference = space.robot.reference
    for pose in space.poses if reference is not None else ():
        if reference is not None and any(space.robot.motion.confuses(reference, q) for q in _own_spots(pose)):
            for zone in sorted(pose.zones):
                what = f"{pose.name} looks like the reference (all joints 0) to the arm"
                rule = "homing ends there, so it must be outside all zones"
                yield PoseConfusion(zone=zone, named=(pose.name,), sentence=f"{what}; {rule}")


def _grown(space: Workspace, crossed: dict[Pair, frozenset[str]]) -> dict[Pair, frozenset[str]]:
    """The zones by move. The zones of a move are also those of each move between poses that look alike."""
    grown = dict(crossed)
    pairs = [(a.name, b.name) for alike in _alike(space) for a, b in permutations(alike)]
    for (one, other), (ends, zones) in product(pairs, crossed.items()):
        if one in ends and other not in ends:
            move = ends - {one} | {other}
            grown[move] = grown.get(move, frozenset()) | zones
    return grown


def _alike(space: Workspace) -> list[tuple[Pose, Pose]]:
    """The pairs of poses that look the same."""
    spots = {pose.name: _spots(space, pose) for pose in space.poses}
    return [
        (a, b)
        for a, b in combinations(space.poses, 2)
        if any(space.robot.motion.confuses(p, q) for p, q in product(spots[a.name], spots[b.name]))
    ]


def _across(space: Workspace, a: Pose, b: Pose) -> frozenset[str]:
    ends = {a.name, b.name}
    return frozenset[str]().union(*(each.zones for each in space.crossings if {each.a, each.b} == ends))


def _spots(space: Workspace, pose: Pose) -> list[Position]:
    """The positions that count as standing at a pose; the reference counts as home if no pose is there."""
    spots, reference = _own_spots(pose), space.robot.reference
    if reference is not None and pose.name == space.home.name:
        spots += [reference] if all(each.q != reference for each in space.poses) else []
    return spots


def _own_spots(pose: Pose) -> list[Position]:
    return [q for q in (pose.q, pose.above) if q is not None]
