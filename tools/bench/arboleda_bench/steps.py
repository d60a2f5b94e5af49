"""The storage recipe as a plain list of commands, for the floors and for trees of other making."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count

from arboleda.drivers import Command, FollowPath, MoveJoints, SetEffector
from arboleda.model.plant_model import Cell
from arboleda.testing.storage_layout import StorageLayout

PATH, STATION = "0B", 1
GOLDEN = 0.6180339887498949  # its multiples fall evenly into any interval


def task(cell: Cell) -> str:
    """The task that all benchmarks give."""
    return f"{cell.name} {PATH} {STATION}"


def storage(cell: Cell, epoch: int = 1) -> list[Command]:
    """The commands of one storage task; the mobile robot stands where the last one ended.

    The pauses of the recipe are left out: one after the task's start and one after each effector command.
    """
    layout, path = StorageLayout(cell), cell.paths[PATH]
    arm, mobile = layout.arm.name, layout.mobile.name
    back = layout.mobile.grid.route(path.nodes[-1], path.nodes[0])
    names = (f"{epoch}-{number}" for number in range(1, 8))
    return [
        FollowPath(id=next(names), robot=mobile, nodes=back),
        FollowPath(id=next(names), robot=mobile, nodes=path.nodes),
        MoveJoints(id=next(names), robot=arm, q=layout.pickup.joints),
        SetEffector(id=next(names), robot=arm, on=True),
        MoveJoints(id=next(names), robot=arm, q=cell.stations[STATION].joints),
        SetEffector(id=next(names), robot=arm, on=False),
        MoveJoints(id=next(names), robot=arm, q=layout.home.joints),
    ]


def end(cell: Cell, step: FollowPath | MoveJoints) -> tuple[float, ...]:
    """The end of a move in the robot's joint states: rad and m."""
    if isinstance(step, FollowPath):
        return StorageLayout(cell).mobile.grid.position(step.nodes[-1])
    return StorageLayout(cell).arm.motion.quantised(step.q)


def lengths(shortest_s: float, longest_s: float) -> Callable[[], float]:
    """A function for the times of moves: spread evenly, never in step with anything periodic."""
    number = count()
    return lambda: shortest_s + (longest_s - shortest_s) * (next(number) * GOLDEN % 1.0)
