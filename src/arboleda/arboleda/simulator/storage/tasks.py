"""Tasks of the storage recipes: which they are, and what their orders name."""

from __future__ import annotations

from arboleda.model.plant_model import Cell, Path, Pose
from arboleda.model.task import Order
from arboleda.recipes.storage import RECIPES
from arboleda.recipes.storage_layout import StorageLayout

NAMES = frozenset(each.name for each in RECIPES)


def stores(cell: Cell) -> bool:
    """True if a cell offers one of the storage recipes."""
    return cell.handover is not None and not NAMES.isdisjoint(each.name for each in cell.recipes)


def only_stores(cell: Cell) -> bool:
    """True if a cell offers nothing else."""
    return stores(cell) and NAMES.issuperset(each.name for each in cell.recipes)


def path_of(layout: StorageLayout, order: Order) -> Path | None:
    """The path on which a task's part comes."""
    code = order.values.get("path")
    return layout.path(code) if code else None


def station_of(layout: StorageLayout, order: Order) -> Pose | None:
    """The station that a task fills, if its text names one."""
    target = order.values.get("station")
    return layout.space.targets[target] if target else None


def is_storage_task(cell: Cell, text: str) -> bool:
    """True if a task's canonical text is of one of the storage recipes."""
    word = text.split()[1]
    others = {each.name for each in cell.recipes} - NAMES
    return word not in others and (word in NAMES or word in cell.paths)
