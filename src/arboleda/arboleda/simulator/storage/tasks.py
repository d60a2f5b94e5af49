"""Tasks of the storage recipes: which they are, and what their orders name."""

from __future__ import annotations

from arboleda.model.plant_model import Cell, Path, Pose
from arboleda.model.task import Order
from arboleda.recipes.storage import RECIPES

NAMES = frozenset(each.name for each in RECIPES)


def stores(cell: Cell) -> bool:
    """True if a cell offers one of the storage recipes."""
    return cell.handover is not None and not NAMES.isdisjoint(each.name for each in cell.recipes)


def only_stores(cell: Cell) -> bool:
    """True if a cell offers nothing else."""
    return stores(cell) and NAMES.issuperset(each.name for each in cell.recipes)


def path_of(order: Order) -> Path | None:
    """The path on which a task's part comes."""
    return order.values.get("path")


def station_of(order: Order) -> Pose | None:
    """The station that a task fills, if its text names one."""
    return order.values.get("station")


def is_storage_task(cell: Cell, text: str) -> bool:
    """True if a task's canonical text is of one of the storage recipes."""
    word = text.split()[1]
    others = {each.name for each in cell.recipes} - NAMES
    return word not in others and (word in NAMES or word in cell.paths)
