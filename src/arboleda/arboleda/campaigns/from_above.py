"""Floor plan: where the devices of a cell stand, from above; an arm is a line, a mobile robot a spot."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from arboleda.dashboard.twin import bodies, kinematics
from arboleda.model.errors import ArboledaError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.urdf import robot_urdf
from arboleda.views.geometry import places

Row = dict[str, Any]
Line = list[list[float]]  # points in m


class FloorPlan:
    """FloorPlan: lines of the devices of a cell that can be drawn, and the nodes of their grids, `grids`."""

    def __init__(self, model: PlantModel, cell: str) -> None:
        self._drawn = {row["name"]: row for row in places(model)["robots"] if row["cell"] == cell}
        bodies_of = {name: _body(model, name, row) for name, row in self._drawn.items()}
        self._bodies = {name: body for name, body in bodies_of.items() if body is not None}
        self.grids = [_on_floor(row["at"], row["nodes"]) for row in self._drawn.values() if "nodes" in row]

    def __contains__(self, name: object) -> bool:
        return name in self._bodies

    def line(self, name: str, *, node: int | None, q: Sequence[float] | None) -> Line:
        """The points of a device at a node of its grid or with these joints; none where that is unknown."""
        drawn, body = self._drawn[name], self._bodies[name]
        if node is not None and "nodes" in drawn:
            return _on_floor(drawn["at"], [drawn["nodes"][node]])
        if q is None or not body:
            return []
        frames = kinematics.place(body, q, kinematics.floor(drawn["at"]))
        return [_rounded(kinematics.at(frames[link["link"]])) for link in bodies.way(body)]


def _body(model: PlantModel, name: str, row: Row) -> Any:
    if "nodes" in row:
        return ()
    try:
        return bodies.read(robot_urdf(model, name))
    except (ArboledaError, ValueError):  # the plan goes without a drawing of it
        return None


def _on_floor(at: Sequence[float], spots: Sequence[Sequence[float]]) -> Line:
    frame = kinematics.floor(at)
    return [_rounded(kinematics.at(frame, (x, y, 0.0))) for x, y in spots]


def _rounded(point: Sequence[float]) -> list[float]:
    return [round(point[0], 3), round(point[1], 3)]
