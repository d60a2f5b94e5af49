"""Positions of a cell's devices in the last seconds, as lines on the floor; of arms as seen from above."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from arboleda.dashboard.twin import bodies, kinematics
from arboleda.model.errors import ArboledaError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.urdf import robot_urdf
from arboleda.recorder.incident import Incident
from arboleda.views.geometry import places

Row = dict[str, Any]
Line = list[list[float]]


def scene(incident: Incident, model: PlantModel) -> Row | None:
    """The time of each frame before the failure, and the line of each robot; None if nothing is drawn."""
    drawn = {row["name"]: row for row in places(model)["robots"] if row["cell"] == incident.cell}
    shapes = {name: body for name, row in drawn.items() if (body := _body(model, name, row)) is not None}
    frames = []
    for at, robots in incident.frames:
        lines = {
            row["name"]: _line(drawn[row["name"]], shapes[row["name"]], row)
            for row in robots
            if row["name"] in shapes
        }
        frames.append({"at": round(at - (incident.failed_at or at), 2), "lines": lines})
    points = [point for frame in frames for line in frame["lines"].values() for point in line]
    if not points:
        return None
    grids = [_on_floor(row["at"], row["nodes"]) for row in drawn.values() if "nodes" in row]
    every = [*points, *(point for grid in grids for point in grid)]
    low = [min(point[axis] for point in every) for axis in (0, 1)]
    high = [max(point[axis] for point in every) for axis in (0, 1)]
    return {"frames": frames, "grids": grids, "low": low, "high": high}


def _body(model: PlantModel, name: str, row: Row) -> Any:
    if "nodes" in row:
        return ()
    try:
        return bodies.read(robot_urdf(model, name))
    except (ArboledaError, ValueError):  # the report goes without a drawing of it
        return None


def _line(drawn: Row, body: Any, row: Row) -> Line:
    if row["node"] is not None and "nodes" in drawn:
        return _on_floor(drawn["at"], [drawn["nodes"][row["node"]]])
    if row["q"] is None or not body:
        return []
    frames = kinematics.place(body, row["q"], kinematics.floor(drawn["at"]))
    return [_rounded(kinematics.at(frames[link["link"]])) for link in bodies.way(body)]


def _on_floor(at: Sequence[float], spots: Sequence[Sequence[float]]) -> Line:
    frame = kinematics.floor(at)
    return [_rounded(kinematics.at(frame, (x, y, 0.0))) for x, y in spots]


def _rounded(point: Sequence[float]) -> list[float]:
    return [round(point[0], 3), round(point[1], 3)]
