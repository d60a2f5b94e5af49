"""Way of a robot's tool along an axis: joints that bring it there, from its drawing and where it stands."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.geometry import kinematics
from arboleda.geometry.bodies import Body
from arboleda.geometry.kinematics import Matrix

AXES = {"x": 0, "y": 1, "z": 2}
NUDGE = 1e-5  # rad or m
DAMPING = 1e-3  # keeps joints still where the arm cannot go on
FREE_JOINTS = 6  # of an arm that can keep its tool as it is turned
Vector = list[float]


def moved(body: Body, q: Sequence[float], *, axis: str, frame: str, metres: float) -> tuple[float, ...]:
    """The joints with the tool so much farther along an axis of the base or of the tool.

    An arm with fewer than six joints may turn its tool by that. Small steps are exact.
    """
    here = kinematics.tool(body, q)
    column = AXES[axis]
    direction = [here[row][column] if frame == "tool" else float(row == column) for row in range(3)]
    wanted = [each * metres for each in direction] + ([0.0] * 3 if len(q) >= FREE_JOINTS else [])
    columns = [_change(body, q, joint, here)[: len(wanted)] for joint in range(len(q))]
    return tuple(now + by for now, by in zip(q, _least(columns, wanted), strict=True))


def _change(body: Body, q: Sequence[float], joint: int, here: Matrix) -> Vector:
    """The change of the tool's place and turn with one joint."""
    there = kinematics.tool(body, [each + NUDGE * (index == joint) for index, each in enumerate(q)])
    shift = [(there[row][3] - here[row][3]) / NUDGE for row in range(3)]
    return shift + [each / NUDGE for each in _turn(here, there)]


def _turn(before: Matrix, after: Matrix) -> Vector:
    """The small turn between two frames, as a vector."""
    by = [
        [sum(after[row][k] * before[column][k] for k in range(3)) for column in range(3)] for row in range(3)
    ]
    return [(by[2][1] - by[1][2]) / 2, (by[0][2] - by[2][0]) / 2, (by[1][0] - by[0][1]) / 2]


def _least(columns: Sequence[Vector], wanted: Vector) -> Vector:
    """The smallest changes of the joints that make the wanted change, damped."""
    size = range(len(wanted))
    square = [
        [sum(each[row] * each[column] for each in columns) + DAMPING**2 * (row == column) for column in size]
        for row in size
    ]
    weights = _solved(square, wanted)
    return [sum(each[row] * weights[row] for row in size) for each in columns]


def _solved(rows: list[Vector], wanted: Vector) -> Vector:
    """The solution of a few linear equations, by elimination."""
    table = [[*row, value] for row, value in zip(rows, wanted, strict=True)]
    for pivot in range(len(table)):
        best = max(range(pivot, len(table)), key=lambda row: abs(table[row][pivot]))
        table[pivot], table[best] = table[best], table[pivot]
        for row in range(len(table)):
            if row != pivot:
                part = table[row][pivot] / table[pivot][pivot]
                table[row] = [a - part * b for a, b in zip(table[row], table[pivot], strict=True)]
    return [row[-1] / row[index] for index, row in enumerate(table)]
