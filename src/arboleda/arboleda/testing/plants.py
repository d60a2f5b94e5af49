"""Plants for tests: the shipped one, or some of its cells, with robots that declare something else."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from importlib.resources import as_file, files
from typing import Any

from arboleda.model.plant_model import PlantModel, Robot
from arboleda.plant_file.loader import load


def shipped(*cells: str, **declared: Any) -> PlantModel:
    """The shipped plant, or only these cells of it; every robot gets `declared`, such as `link=Link.ROS`."""
    plant = _loaded()
    by_name = {cell.name: cell for cell in plant.cells}
    chosen = [by_name[name] for name in cells or by_name]
    return replace(
        plant,
        cells=tuple(cell.with_robots(lambda robot: replace(robot, **declared)) for cell in chosen),
    )


def shared() -> PlantModel:
    """The second packaged plant, with the features that the shipped one does not use."""
    with as_file(files("arboleda") / "plants" / "shared.yaml") as path:
        return load(path)


def slowed(plant: PlantModel, times: float) -> PlantModel:
    """The plant with arms so many times slower, for tests of what must happen in the middle of a move."""

    def slower(robot: Robot) -> Robot:
        if not robot.joints:
            return robot
        joints = tuple(replace(joint, speed=joint.speed / times) for joint in robot.joints)
        return replace(robot, joints=joints)  # type: ignore[call-arg]

    return replace(plant, cells=tuple(cell.with_robots(slower) for cell in plant.cells))


@cache
def _loaded() -> PlantModel:
    return load()
