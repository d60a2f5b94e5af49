"""Positions of a cell's devices in the last seconds, as lines on the floor; of arms as seen from above."""

from __future__ import annotations

from typing import Any

from arboleda.model.plant_model import PlantModel
from arboleda_proofs.campaigns.from_above import FloorPlan
from arboleda_proofs.playback.incident import Incident

Row = dict[str, Any]


def scene(incident: Incident, model: PlantModel) -> Row | None:
    """The time of each frame before the failure, and the line of each robot; None if nothing is drawn."""
    plan = FloorPlan(model, incident.cell)
    drawings: list[tuple[float, dict[str, list[list[float]]]]] = []
    for at, robots in incident.frames:
        drawn = [row for row in robots if row["name"] in plan]
        lines = {row["name"]: plan.line(row["name"], node=row["node"], q=row["q"]) for row in drawn}
        drawings.append((round(at - (incident.failed_at or at), 2), lines))
    points = [point for _, lines in drawings for line in lines.values() for point in line]
    if not points:
        return None
    every = [*points, *(point for grid in plan.grids for point in grid)]
    low = [min(point[axis] for point in every) for axis in (0, 1)]
    high = [max(point[axis] for point in every) for axis in (0, 1)]
    frames = [{"at": at, "lines": lines} for at, lines in drawings]
    return {"frames": frames, "grids": plan.grids, "low": low, "high": high}
