"""Plants for tests: the shipped one, or some of its cells, with robots that declare something else."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

from arboleda.kinds.arm import Arm
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.loader import load
from arboleda.recipes.storage_cell import StorageCell


def shipped(*cells: str, **declared: Any) -> PlantModel:
    """The shipped plant, or only these cells of it; every robot gets `declared`, such as `link=Link.ROS`."""
    plant = _loaded()
    by_name = {cell.name: cell for cell in plant.cells}
    return replace(plant, cells=tuple(_declaring(by_name[name], declared) for name in cells or by_name))


def slowed(plant: PlantModel, times: float) -> PlantModel:
    """The plant with arms so many times slower, for tests of what must happen in the middle of a move."""
    return replace(plant, cells=tuple(replace(cell, arm=_slower(cell.arm, times)) for cell in plant.cells))


def _slower(arm: Arm, times: float) -> Arm:
    return replace(arm, joints=tuple(replace(joint, speed=joint.speed / times) for joint in arm.joints))


@cache
def _loaded() -> PlantModel:
    return load()


def _declaring(cell: StorageCell, declared: dict[str, Any]) -> StorageCell:
    return replace(cell, arm=replace(cell.arm, **declared), mobile=replace(cell.mobile, **declared))
