"""Moment of a breach: the tree of the cell then, and where its devices truly were."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import Any

from arboleda.model.facts import shown
from arboleda.views import tree_view

from ..from_above import FloorPlan, Line
from .stage import Stage

MARGIN_M = 0.3


@dataclass(frozen=True, kw_only=True)
class Moment:
    """Moment: rows of the tree, true facts of each device, lines on the floor, nodes of grids."""

    tree: Sequence[dict[str, Any]] = ()
    facts: Mapping[str, str] = field(default_factory=dict)
    lines: Mapping[str, Line] = field(default_factory=dict)
    grids: Sequence[Line] = ()


class Witness:
    """Witness of a stage: keeps the tree of its cell as it was last, before anything judges the step."""

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self._tree: Sequence[dict[str, Any]] = ()
        stage.world.watchers.insert(0, self._look)

    def _look(self) -> None:
        run = self._stage.run
        if run.tree is not None:
            self._tree = tree_view.rows(run.tree, self._stage.world.now)

    @property
    def moment(self) -> Moment:
        """The moment at which the run stands now."""
        stage, plan = self._stage, FloorPlan(self._stage.world.model, self._stage.cell.name)
        facts, lines = {}, {}
        for robot in stage.cell.robots:
            truth = stage.watched.truth.robots.get(robot.name)
            if truth is None:
                continue
            place = truth.body.true_place
            if robot.name in plan:
                node, q = (place, None) if isinstance(place, int) else (None, place)
                lines[robot.name] = plan.line(robot.name, node=node, q=q)
            true = ", ".join(f"{fact}: {shown(value)}" for fact, value in truth.body.true_facts.items())
            facts[robot.name] = true
        return Moment(tree=self._tree, facts=facts, lines=lines, grids=plan.grids)


def as_svg(moment: Moment) -> str:
    """The devices from above, as a picture that needs no other file; empty where nothing is drawn."""
    lines = {name: line for name, line in moment.lines.items() if line}
    points = [point for line in (*lines.values(), *moment.grids) for point in line]
    if not lines:
        return ""
    low = [min(point[axis] for point in points) - MARGIN_M for axis in (0, 1)]
    high = [max(point[axis] for point in points) + MARGIN_M for axis in (0, 1)]
    box = f"{low[0]:g} {-high[1]:g} {high[0] - low[0]:g} {high[1] - low[1]:g}"
    nodes = (point for grid in moment.grids for point in grid)
    spots = "".join(f'<circle cx="{x:g}" cy="{-y:g}" r="0.02" fill="#8c959f"/>' for x, y in nodes)
    return f'<svg viewBox="{box}" width="360">{spots}{"".join(map(_robot, lines, lines.values()))}</svg>'


def _robot(name: str, line: Line) -> str:
    points, (x, y) = " ".join(f"{px:g},{-py:g}" for px, py in line), line[-1]
    style = 'fill="none" stroke="#0969da" stroke-width="0.04" stroke-linejoin="round"'
    return (
        f'<polyline points="{points}" {style}/><circle cx="{x:g}" cy="{-y:g}" r="0.05" fill="#b42318"/>'
        f'<text x="{x + 0.07:g}" y="{-y:g}" font-size="0.1">{escape(name)}</text>'
    )
