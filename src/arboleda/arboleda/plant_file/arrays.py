"""Arrays of targets: a group of rows and columns whose corners the plant file has.

Between the corners the joints of an arm are interpolated. That is exact only for sliding joints:
`layout_check` measures the distance from an even grid in space. A mobile robot stands on nodes, so each
target of its array must be a node.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from arboleda.model.commands import Position
from arboleda.model.plant_model import Pose, Robot
from arboleda.model.sentence import OWN

from .document import Document, Place, misnamed
from .shapes import ArrayShape
from .target_pose import target_pose

CORNER = "corner"
ROUNDING = 1e-9
MOST = 400  # targets of one array
ORDER = "the first and the last of the first row, then the first and the last of the last row"
NODE_OFF = "{name} would be between nodes; the corners must lie so that each target is on one"


@dataclass(frozen=True, kw_only=True)
class Array:
    """A group of `rows` times `columns` targets, `pallet_1` and so on, row by row."""

    group: str
    rows: int
    columns: int

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(f"{self.group}_{number}" for number in range(1, self.rows * self.columns + 1))

    @property
    def corners(self) -> tuple[int, ...]:
        """The indices of the corner targets, without those that a single row or column would repeat."""
        last = self.rows * self.columns - 1
        return tuple(dict.fromkeys((0, self.columns - 1, last - self.columns + 1, last)))

    def weights(self, index: int) -> tuple[float, ...]:
        """The share of each of the `corners` in a target's position."""
        row, column = divmod(index, self.columns)
        down, along = row / max(self.rows - 1, 1), column / max(self.columns - 1, 1)
        by_corner: dict[int, float] = {}
        last = self.rows * self.columns - 1
        four = (0, self.columns - 1, last - self.columns + 1, last)
        shares = ((1 - down) * (1 - along), (1 - down) * along, down * (1 - along), down * along)
        for corner, share in zip(four, shares, strict=True):
            by_corner[corner] = by_corner.get(corner, 0.0) + share
        return tuple(by_corner.values())

    def even(self, index: int, corners: Sequence[Sequence[float]]) -> tuple[float, ...]:
        """The position of a target between the corners if rows and columns were even in space."""
        return _sums(corners, self.weights(index))


def is_array(document: Document, place: Place) -> bool:
    """True if a group is an array: a mapping. A group that is a list has the names of targets."""
    return isinstance(document.value(place), dict)


def arrays(document: Document, cell: Place) -> tuple[Array, ...]:
    """The arrays of a cell; problems of the others are kept."""
    here = (*cell, "groups")
    whole = []
    for name in document.keys(here):
        place = (*here, name)
        shape = document.read(ArrayShape, place) if is_array(document, place) else None
        if shape is None:
            continue
        rows, columns = shape.grid
        if not 2 <= rows * columns <= MOST:
            number = f"is {rows} x {columns}"
            document.problem((*place, "grid"), f"an array has 2 to {MOST} targets; this one {number}")
            continue
        whole.append(Array(group=name, rows=rows, columns=columns))
    return tuple(whole)


def poses(
    document: Document, cell: Place, array: Array, robots: Mapping[str, Robot]
) -> dict[str, list[Pose | None]]:
    """By role, the poses of each robot that has corners; None for a wrong pose, whose problem is kept."""
    here = (*cell, "groups", array.group, "corners")
    by_role: dict[str, list[Pose | None]] = {}
    for role in document.keys(here):
        place = (*here, role)
        if role not in robots:
            document.problem(place, misnamed(role, robots, "no device of this cell goes anywhere"), at=place)
            continue
        rows = document.value(place)
        if not isinstance(rows, list) or len(rows) != len(array.corners):
            which = ORDER if len(array.corners) > 2 else "the first and the last"
            document.problem(place, f"must be a list of {len(array.corners)} corners: {which}", at=place)
            by_role[role] = [None]
            continue
        corners = [target_pose(document, (*place, index), robots[role], CORNER) for index in range(len(rows))]
        whole = [pose for pose in corners if pose is not None]
        if len(whole) < len(corners):
            by_role[role] = [None]
        else:
            by_role[role] = _between(document, place, array, whole, robots[role])
    return by_role


def _between(
    document: Document, place: Place, array: Array, corners: Sequence[Pose], robot: Robot
) -> list[Pose | None]:
    """The poses of all targets of an array for one robot."""
    lifted = [pose.above is not None for pose in corners]
    if any(lifted) and not all(lifted):
        document.problem(place, "either every corner has an approach_mm or none", at=place)
        return [None]
    made: list[Pose | None] = []
    for index, name in enumerate(array.names):
        weights = array.weights(index)
        q = _mixed([pose.q for pose in corners], weights, robot)
        if q is None:
            document.problem(place, NODE_OFF.format(name=name), at=place)
            return [None]
        above = _mixed([pose.above or pose.q for pose in corners], weights, robot) if all(lifted) else None
        made.append(Pose(name=name, title=OWN(text=name), q=q, above=above))
    return made


def _mixed(corners: Sequence[Position], weights: Sequence[float], robot: Robot) -> Position | None:
    """The position with these shares of the corners; None where a mobile robot would be between nodes."""
    if robot.floor_grid:
        columns = robot.floor_grid.columns
        rows = _sums([divmod(node, columns) for node in corners if isinstance(node, int)], weights)
        row, column = map(round, rows)
        on_nodes = math.dist(rows, (row, column)) < ROUNDING
        return row * columns + column if on_nodes else None
    return _sums([q for q in corners if isinstance(q, tuple)], weights)


def _sums(points: Sequence[Sequence[float]], weights: Sequence[float]) -> tuple[float, ...]:
    """The weighted sum of some points."""
    pairs = [*zip(weights, points, strict=True)]
    return tuple(sum(weight * point[axis] for weight, point in pairs) for axis in range(len(points[0])))
