"""Poses that an arm cannot tell apart, for it may stop at the one and count as standing at the other.

An arm counts as standing at a pose within its tolerance of it, and may stop that far from its goal. So two
poses that are no further apart than twice the tolerance, in every joint, look the same.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, permutations, product

from arboleda.core.model import Crossing, Pose
from arboleda.recipes.storage_cell import StorageCell

ROUNDING = 1e-9  # rad or m, far below a motor step
WHY = "in every joint they are within twice the arm's tolerance of each other, so it cannot tell them apart"
Position = tuple[float, ...]
Pair = frozenset[str]  # of names of poses


@dataclass(frozen=True, kw_only=True)
class Confusion:
    """Why a zone cannot have what is `named` for it: one pose, or the two ends of a move."""

    zone: str
    named: tuple[str, ...]
    sentence: str


def with_alike_crossings(cell: StorageCell) -> StorageCell:
    """The cell, a move of a pose crossing whatever that move crosses from a pose that looks the same."""
    crossed = {frozenset({each.a, each.b}): each.zones for each in cell.crossings}
    while (grown := _grown(cell, crossed)) != crossed:
        crossed = grown
    rows = sorted((tuple(sorted(pair)), zones) for pair, zones in crossed.items())
    return replace(cell, crossings=tuple(Crossing(a=a, b=b, zones=zones) for (a, b), zones in rows))


def confusions(cell: StorageCell) -> list[Confusion]:
    """Everything in the zones of a cell of which nobody would know whether the arm is in it."""
    return list(_at_reference(cell)) or list(_between_poses(cell))


def _between_poses(cell: StorageCell) -> Iterator[Confusion]:
    for a, b in _alike(cell):
        for inside, outside in permutations((a, b)):
            for zone in sorted(inside.zones - outside.zones):
                what = f"{inside.name} lies in the zone and {outside.name} does not"
                yield Confusion(zone=zone, named=(inside.name,), sentence=f"{what}; {WHY}")
        for zone in sorted(_across(cell, a, b)):
            what = f"a move between {a.name} and {b.name} crosses the zone"
            yield Confusion(zone=zone, named=(a.name, b.name), sentence=f"{what}; {WHY}")


def _at_reference(cell: StorageCell) -> Iterator[Confusion]:
    """Homing ends at the reference, so it lies outside all zones."""
    reference = cell.arm.quantised(cell.arm.reference)
    for pose in cell.poses:
        if any(_same(cell, reference, q) for q in _own_spots(cell, pose)):
            for zone in sorted(pose.zones):
                what = f"{pose.name} looks like the reference (all joints 0) to the arm"
                rule = "homing ends there, so it must be outside all zones"
                yield Confusion(zone=zone, named=(pose.name,), sentence=f"{what}; {rule}")


def _grown(cell: StorageCell, crossed: dict[Pair, frozenset[str]]) -> dict[Pair, frozenset[str]]:
    """The zones by move, each move's also for those from a pose that looks like one of its ends."""
    grown = dict(crossed)
    pairs = [(a.name, b.name) for alike in _alike(cell) for a, b in permutations(alike)]
    for (one, other), (ends, zones) in product(pairs, crossed.items()):
        if one in ends and other not in ends:
            move = ends - {one} | {other}
            grown[move] = grown.get(move, frozenset()) | zones
    return grown


def _alike(cell: StorageCell) -> list[tuple[Pose, Pose]]:
    """The pairs of poses that look the same."""
    spots = {pose.name: _spots(cell, pose) for pose in cell.poses}
    return [
        (a, b)
        for a, b in combinations(cell.poses, 2)
        if any(_same(cell, p, q) for p, q in product(spots[a.name], spots[b.name]))
    ]


def _across(cell: StorageCell, a: Pose, b: Pose) -> frozenset[str]:
    ends = {a.name, b.name}
    return frozenset[str]().union(*(each.zones for each in cell.crossings if {each.a, each.b} == ends))


def _spots(cell: StorageCell, pose: Pose) -> list[Position]:
    """Where an arm counts as standing at a pose; the reference counts as home where no pose is there."""
    spots = _own_spots(cell, pose)
    if pose.name == cell.home.name and all(each.q != cell.arm.reference for each in cell.poses):
        spots.append(cell.arm.quantised(cell.arm.reference))
    return spots


def _own_spots(cell: StorageCell, pose: Pose) -> list[Position]:
    return [cell.arm.quantised(q) for q in (pose.q, pose.above) if q is not None]


def _same(cell: StorageCell, p: Sequence[float], q: Sequence[float]) -> bool:
    rows = zip(p, q, cell.arm.tolerances, strict=True)
    return all(abs(a - b) <= 2 * within + ROUNDING for a, b, within in rows)
