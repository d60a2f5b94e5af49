"""Where things of a plant stand and which poses lie where, as plain data; m and rad, as the file says it."""

from __future__ import annotations

from typing import Any

from arboleda.core.commands import Position
from arboleda.core.model import PlantModel, Pose, Workspace
from arboleda.kinds.arm import Arm
from arboleda.kinds.floor import Placement
from arboleda.kinds.mobile import Mobile
from arboleda.recipes.storage_cell import StorageCell

Row = dict[str, Any]


def places(model: PlantModel) -> Row:
    """Robots with their floor places and speeds, cells with grid and poses, zones with what lies in them."""
    cells = [cell for cell in model.cells if isinstance(cell, StorageCell)]
    return {
        "robots": [row for cell in cells for row in (_arm(cell), _mobile(cell))],
        "cells": [_cell(cell) for cell in cells],
        "zones": [{"zone": zone, "spots": _spots(model, zone)} for zone in model.zones],
    }


def _arm(cell: StorageCell) -> Row:
    arm: Arm = cell.arm
    speeds = [joint.speed for joint in arm.joints]
    return {
        "name": arm.name,
        "cell": cell.name,
        "kind": "arm",
        "at": _floor(arm.base),
        "speeds": speeds,
        "reference": list(arm.reference),
    }


def _mobile(cell: StorageCell) -> Row:
    mobile: Mobile = cell.mobile
    nodes = [list(mobile.grid.position(node)) for node in range(mobile.grid.size)]
    return {
        "name": mobile.name,
        "cell": cell.name,
        "kind": "mobile",
        "at": _floor(mobile.grid.origin),
        "speeds": [mobile.speed, mobile.speed],
        "reference": nodes[0],
        "nodes": nodes,
    }


def _cell(cell: StorageCell) -> Row:
    grid = cell.mobile.grid
    return {
        "name": cell.name,
        "arm": cell.arm.name,
        "mobile": cell.mobile.name,
        "pitch": grid.pitch,
        "columns": grid.columns,
        "pickups": [list(pickup.joints) for pickup in cell.every_pickup],
        "stations": [list(station.joints) for station in cell.stations],
    }


def _spots(model: PlantModel, zone: str) -> list[Row]:
    """What lies in a zone: poses, and moves from one pose to another; each as {robot, path of joints}."""
    return [
        spot for cell in model.cells for space in cell.workspaces.values() for spot in _in_space(space, zone)
    ]


def _in_space(space: Workspace, zone: str) -> list[Row]:
    poses = {pose.name: pose for pose in space.poses}
    inside = [_reach(pose) for pose in space.poses if zone in pose.zones]
    ways = [[poses[way.a].q, poses[way.b].q] for way in space.crossings if zone in way.zones]
    return [{"robot": space.robot.name, "path": [_numbers(q) for q in path]} for path in [*inside, *ways]]


def _reach(pose: Pose) -> list[Position]:
    return [pose.q] if pose.above is None else [pose.q, pose.above]


def _numbers(position: Position) -> list[float]:
    return [position] if isinstance(position, int) else list(position)


def _floor(placement: Placement) -> list[float]:
    return [placement.x, placement.y, placement.yaw]
