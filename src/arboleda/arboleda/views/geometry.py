"""Places of a plant: its things and the poses in its zones, as plain data; m and rad, as in the file."""

from __future__ import annotations

from typing import Any

from arboleda.model.commands import Position
from arboleda.model.plant_model import Cell, PlantModel, Pose, Workspace

Row = dict[str, Any]


def places(model: PlantModel) -> Row:
    """Robots with their floor places and speeds, cells with grid and poses, the places of parts, the
    targets of robots, zones with what lies in them.

    Robots and cells that offer no drawing are left out.
    """
    robots = [(cell, robot, robot.drawn()) for cell in model.cells for robot in cell.robots]
    cells = [(cell.name, handover(cell)) for cell in model.cells]
    return {
        "robots": [
            {"name": robot.name, "cell": cell.name, "kind": robot.kind_name, **drawn}
            for cell, robot, drawn in robots
            if drawn is not None
        ],
        "cells": [{"name": name, **drawing} for name, drawing in cells if drawing is not None],
        "parts": [spot for cell in model.cells for spot in _of_parts(cell)],
        "targets": [target for cell in model.cells for target in _targets(cell)],
        "zones": [{"zone": zone, "spots": _spots(model, zone)} for zone in model.zones],
    }


def handover(cell: Cell) -> Row | None:
    """The robots that hand parts over, the poses at which they do, and the stations; None where none do."""
    if cell.handover is None:
        return None
    taker, giver = cell.reach[cell.handover.taker], cell.reach[cell.handover.giver]
    grid = giver.robot.floor_grid
    if grid is None or not taker.robot.joints:
        return None
    return {
        "arm": taker.robot.name,
        "mobile": giver.robot.name,
        "pitch": grid.pitch,
        "columns": grid.columns,
        "pickups": [list(pose.joints) for pose in taker.at(cell.handover.targets)],
        "stations": [list(station.joints) for station in cell.stations],
    }


def _of_parts(cell: Cell) -> list[Row]:
    """The places of a cell that one of its drawn robots reaches: {cell, place, robot, q} of the first."""
    drawn = [space for space in cell.spaces if _is_drawn(space)]
    reached = [
        (place.target, next((space for space in drawn if place.target in space.targets), None))
        for place in cell.counted
    ]
    return [
        {"cell": cell.name, "place": target, "robot": space.robot.name, "q": _joints(space, target)}
        for target, space in reached
        if space is not None
    ]


def _targets(cell: Cell) -> list[Row]:
    """The targets of the drawn robots of a cell: {cell, role, name, robot, q}."""
    return [
        {
            "cell": cell.name,
            "role": role,
            "name": name,
            "robot": robot.name,
            "q": _joints(cell.reach[robot.name], name),
        }
        for role, robot in cell.roles.items()
        if robot.name in cell.reach and _is_drawn(cell.reach[robot.name])
        for name in cell.reach[robot.name].targets
    ]


def _joints(space: Workspace, target: str) -> list[float]:
    return _numbers(space.targets[target].q, (space.robot.drawn() or {}).get("nodes"))


def _spots(model: PlantModel, zone: str) -> list[Row]:
    """The poses in a zone, and the moves from one pose to another; each as {robot, path of joints}."""
    spaces = [space for cell in model.cells for space in cell.workspaces.values() if _is_drawn(space)]
    return [spot for space in spaces for spot in _in_space(space, zone)]


def _is_drawn(space: Workspace) -> bool:
    return space.robot.drawn() is not None


def _in_space(space: Workspace, zone: str) -> list[Row]:
    poses = {pose.name: pose for pose in space.poses}
    nodes = (space.robot.drawn() or {}).get("nodes")
    inside = [_reach(pose) for pose in space.poses if zone in pose.zones]
    ways = [[poses[way.a].q, poses[way.b].q] for way in space.crossings if zone in way.zones]
    paths = [[_numbers(q, nodes) for q in path] for path in [*inside, *ways]]
    return [{"robot": space.robot.name, "path": path} for path in paths]


def _reach(pose: Pose) -> list[Position]:
    return [pose.q] if pose.above is None else [pose.q, pose.above]


def _numbers(position: Position, nodes: Any) -> list[float]:
    """The joints of an arm; for a robot on nodes, the place of the node on the floor."""
    return list(nodes[position]) if isinstance(position, int) else list(position)
