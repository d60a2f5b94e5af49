"""Cells of the shipped plant with other robots or other poses."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from arboleda.model.plant_model import Cell, Crossing, Pose


def with_robot(cell: Cell, role: str, **declared: Any) -> Cell:
    """The cell whose robot in this role declares something else."""
    name = cell.roles[role].name
    return cell.with_robots(lambda robot: replace(robot, **declared) if robot.name == name else robot)


def with_poses(cell: Cell, *crossings: Crossing, **poses: Pose) -> Cell:
    """The cell with other poses of its arm by target, `pickup` or `station_4`, and with these crossings."""
    arm, *others = cell.spaces
    changed = {arm.targets[target].name: pose for target, pose in poses.items()}
    names = {old: pose.name for old, pose in changed.items()}
    space = replace(
        arm,
        home=changed.get(arm.home.name, arm.home),
        poses=tuple(changed.get(pose.name, pose) for pose in arm.poses),
        target_names=tuple((target, names.get(name, name)) for target, name in arm.target_names),
        crossings=crossings,
    )
    return replace(cell, spaces=(space, *others))


def with_palletizing(cell: Cell, pick: str, place: str) -> Cell:
    """The cell whose arm takes parts from one target and puts them at another in its own cycle."""
    arrays = dict(cell.arrays) | {"palletizing": (pick, place)}
    return replace(cell, arrays=tuple(arrays.items()))
