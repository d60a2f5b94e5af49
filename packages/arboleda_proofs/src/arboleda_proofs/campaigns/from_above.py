"""Floor plan: where the devices of a cell stand, from above; an arm is a line, a mobile robot a spot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import TYPE_CHECKING, Any

from arboleda.drivers import shown
from arboleda.extension import ArboledaError
from arboleda.geometry import bodies, kinematics
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.urdf import robot_urdf
from arboleda.views.geometry import places

if TYPE_CHECKING:  # who draws a plant that runs needs no simulator
    from arboleda_proofs.simulator.judged_world import JudgedWorld

Row = dict[str, Any]
Line = list[list[float]]  # points in m
MARGIN_M = 0.3
WIDTH, HEIGHT = 360, 300  # px


@dataclass(frozen=True, kw_only=True)
class Scene:
    """Scene: true facts of each device in words, lines on the floor, nodes of grids, targets of arms."""

    facts: Mapping[str, str] = field(default_factory=dict)
    lines: Mapping[str, Line] = field(default_factory=dict)
    grids: Sequence[Line] = ()
    targets: Line = field(default_factory=list)


class FloorPlan:
    """FloorPlan: lines of the devices of a cell that can be drawn, and the nodes of their grids, `grids`."""

    def __init__(self, model: PlantModel, cell: str) -> None:
        drawn = places(model)
        self._cell = cell
        self._drawn = {row["name"]: row for row in drawn["robots"] if row["cell"] == cell}
        bodies_of = {name: _body(model, name, row) for name, row in self._drawn.items()}
        self._bodies = {name: body for name, body in bodies_of.items() if body is not None}
        self.grids = [_on_floor(row["at"], row["nodes"]) for row in self._drawn.values() if "nodes" in row]
        of_arms = [row for row in drawn["targets"] if row["robot"] in self and row["cell"] == cell]
        lines = [self.line(row["robot"], node=None, q=row["q"] or None) for row in of_arms]
        self.targets = [line[-1] for line in lines if line]

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
        return [_rounded(kinematics.at(frames[link["link"]])) for link in bodies.tool_chain(body)]

    def scene(self, watched: JudgedWorld) -> Scene:
        """The devices of the cell as they truly are in a world of this plant, whatever the plant believes."""
        facts, lines = {}, {}
        for robot in watched.world.model.cell(self._cell).robots:
            truth = watched.truth.robots.get(robot.name)
            if truth is None:
                continue
            place = truth.body.true_place
            if robot.name in self:
                node, q = (place, None) if isinstance(place, int) else (None, place)
                lines[robot.name] = self.line(robot.name, node=node, q=q)
            true = [f"{fact}: {shown(value)}" for fact, value in truth.body.true_facts.items()]
            true += [f"node: {place}"] if isinstance(place, int) else []
            facts[robot.name] = ", ".join(true)
        return Scene(facts=facts, lines=lines, grids=self.grids, targets=self.targets)


def as_svg(scene: Scene) -> str:
    """The devices from above, as a picture that needs no other file; empty where nothing is drawn."""
    lines = {name: line for name, line in scene.lines.items() if line}
    points = [point for line in (*lines.values(), *scene.grids, scene.targets) for point in line]
    if not lines:
        return ""
    low = [min(point[axis] for point in points) - MARGIN_M for axis in (0, 1)]
    high = [max(point[axis] for point in points) + MARGIN_M for axis in (0, 1)]
    box = f"{low[0]:g} {-high[1]:g} {high[0] - low[0]:g} {high[1] - low[1]:g}"
    nodes = (point for grid in scene.grids for point in grid)
    spots = [f'<circle cx="{x:g}" cy="{-y:g}" r="0.02" fill="#8c959f"/>' for x, y in nodes]
    ring = 'r="0.015" fill="none" stroke="#8c959f" stroke-width="0.01"'
    spots += [f'<circle cx="{x:g}" cy="{-y:g}" {ring}/>' for x, y in scene.targets]
    robots = map(_robot, lines, lines.values())
    size = f'width="{WIDTH}" height="{HEIGHT}"'
    drawn = "".join((*spots, *robots))
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" {size}>{drawn}</svg>'


def _robot(name: str, line: Line) -> str:
    points, (x, y) = " ".join(f"{px:g},{-py:g}" for px, py in line), line[-1]
    style = 'fill="none" stroke="#0969da" stroke-width="0.04" stroke-linejoin="round"'
    return (
        f'<polyline points="{points}" {style}/><circle cx="{x:g}" cy="{-y:g}" r="0.05" fill="#b42318"/>'
        f'<text x="{x + 0.07:g}" y="{-y:g}" font-size="0.1">{escape(name)}</text>'
    )


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
