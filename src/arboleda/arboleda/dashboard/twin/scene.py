"""The fixed things of a plant as one plain piece of data that a browser draws; m and rad."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from arboleda.geometry import bodies, kinematics
from arboleda.geometry.bodies import Body
from arboleda.geometry.hull import hull
from arboleda.geometry.part_size import PART_HEIGHT_M, PART_RADIUS_M

Row = dict[str, Any]
MARGIN = 0.08  # m around what is known to lie in a zone
WIDE = 0.05  # m beyond the outermost robot, grid or station
SHELF = 0.025  # m of a rack's board around the middle of its stations
UPRIGHT = 0.99  # from here on a tool points down, so that it puts parts onto a board
STEPS = 8  # points on a move that crosses a zone


def scene(places: Row, drawings: Mapping[str, Body]) -> Row:
    """The scene of a plant: its `places` as `views.places` has them, and a body for each robot."""
    robots = {robot["name"]: robot for robot in places["robots"]}
    cells = [_cell(cell, robots, drawings) for cell in places["cells"]]
    spots = [_place(spot, robots, drawings) for spot in places["parts"]]
    zones = [_zone(zone, robots, drawings) for zone in places["zones"] if zone["spots"]]
    return {
        "part": [PART_RADIUS_M, PART_HEIGHT_M],
        "robots": [_robot(robot, drawings[robot["name"]]) for robot in places["robots"]],
        "cells": cells,
        "places": spots,
        "targets": [_target(target, robots, drawings) for target in places.get("targets", ())],
        "zones": zones,
        "bounds": _bounds(places, cells, spots, drawings),
    }


def _robot(robot: Row, body: Body) -> Row:
    kept = {key: robot[key] for key in ("name", "cell", "kind", "at", "reference")}
    return {
        **kept,
        "body": body,
        "tip": bodies.tip(body),
        "deck": kinematics.deck(body) if "nodes" in robot else 0.0,
    }


def _cell(cell: Row, robots: Mapping[str, Row], drawings: Mapping[str, Body]) -> Row:
    mobile = robots[cell["mobile"]]
    stations = [_frame(robots[cell["arm"]], drawings, q) for q in cell["stations"]]
    return {
        "name": cell["name"],
        "arm": cell["arm"],
        "mobile": cell["mobile"],
        "grid": {
            "at": mobile["at"],
            "nodes": mobile["nodes"],
            "pitch": cell["pitch"],
            "columns": cell["columns"],
        },
        "pickups": [_frame(robots[cell["arm"]], drawings, q) for q in cell["pickups"]],
        "stations": stations,
        "shelves": _shelves(stations),
    }


def _place(spot: Row, robots: Mapping[str, Row], drawings: Mapping[str, Body]) -> Row:
    """A place where parts lie, with the frame of the tool that reaches it."""
    frame = _frame(robots[spot["robot"]], drawings, spot["q"])
    return {"cell": spot["cell"], "place": spot["place"], "frame": frame}


def _target(target: Row, robots: Mapping[str, Row], drawings: Mapping[str, Body]) -> Row:
    """A target of a robot in a role of its cell, with the place of the tool there."""
    frame = _frame(robots[target["robot"]], drawings, target["q"])
    at = [round(frame[number], 4) for number in (3, 7, 11)]
    return {"cell": target["cell"], "role": target["role"], "name": target["name"], "at": at}


def _shelves(stations: Sequence[Sequence[float]]) -> list[Row]:
    """The rack's boards: one at each height at which parts stand upright, {outline, top} in m."""
    levels: dict[float, list[tuple[float, float]]] = {}
    for frame in stations:
        if frame[10] < -UPRIGHT:
            levels.setdefault(round(frame[11] - PART_HEIGHT_M, 3), []).append((frame[3], frame[7]))
    return [{"outline": hull(spots, SHELF), "top": top} for top, spots in levels.items()]


def _frame(arm: Row, drawings: Mapping[str, Body], q: Sequence[float]) -> list[float]:
    """The tool's frame at a pose, 16 numbers row by row."""
    return kinematics.flat(kinematics.tool(drawings[arm["name"]], q, kinematics.floor(arm["at"])))


def _zone(zone: Row, robots: Mapping[str, Row], drawings: Mapping[str, Body]) -> Row:
    """A prism around the tool at every pose of the zone, on every move that crosses it, and around a mobile
    robot that stands there.
    """
    spots = [spot for given in zone["spots"] for spot in _spots(given, robots, drawings)]
    heights = [z for _, _, z in spots]
    return {
        "zone": zone["zone"],
        "outline": hull([(x, y) for x, y, _ in spots], MARGIN),
        "low": max(0.0, min(heights, default=0.0) - MARGIN),
        "high": max(heights, default=0.0) + MARGIN,
    }


def _spots(given: Row, robots: Mapping[str, Row], drawings: Mapping[str, Body]) -> list[tuple[float, ...]]:
    arm = robots[given["robot"]]
    base, body = kinematics.floor(arm["at"]), drawings[arm["name"]]
    return [kinematics.at(kinematics.tool(body, q, base)) for q in _between(given["path"])]


def _between(path: list[list[float]]) -> list[list[float]]:
    """The joint positions at the ends of a path and between them."""
    if len(path) == 1:
        return path
    start, end = path
    shares = [step / STEPS for step in range(STEPS + 1)]
    return [[a + (b - a) * share for a, b in zip(start, end, strict=True)] for share in shares]


def _bounds(
    places: Row, cells: list[Row], spots: list[Row], drawings: Mapping[str, Body]
) -> list[list[float]]:
    """The lowest and highest x, y, z of the scene; a robot without goals counts by its tool at reference."""
    points = [kinematics.at(kinematics.floor(robot["at"])) for robot in places["robots"]]
    for robot in places["robots"]:
        frame = kinematics.floor(robot["at"])
        points += [kinematics.at(frame, (x, y, 0.0)) for x, y in robot.get("nodes", ())]
    in_cells = {cell["name"] for cell in cells}
    for robot in (robot for robot in places["robots"] if robot["cell"] not in in_cells):
        frame, body = kinematics.floor(robot["at"]), drawings[robot["name"]]
        points.append(kinematics.at(kinematics.tool(body, robot["reference"], frame)))
    frames = [frame for cell in cells for frame in [*cell["pickups"], *cell["stations"]]]
    frames += [spot["frame"] for spot in spots]
    points += [(frame[3], frame[7], frame[11]) for frame in frames]
    low = [min(point[axis] for point in points) - WIDE for axis in range(3)]
    return [low, [max(point[axis] for point in points) + WIDE for axis in range(3)]]
