"""Parts of views for cells at rest, kept from one view to the next."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from arboleda.engine import Belief, CellRun, Entry, Plant
from arboleda.model.cell_states import CellState

from .view import CellPart, cell_part


@dataclass(frozen=True, kw_only=True)
class PartRevision:
    """A part as of one revision of its cell, with the sources of the times in it."""

    revision: int
    part: CellPart
    robots: list[tuple[dict[str, Any], Belief, Entry | None]]


class RestingCells:
    """Parts of one plant's views: those of cells at rest are made anew only once their revision has changed.

    Their times and rates of reports are of now in every view. A cell at work is always made anew, and so is
    one that shares something: what it waits for may be with any other cell. The rows of two views may be the
    same objects, so nobody may change them.
    """

    def __init__(self) -> None:
        self._known: dict[str, PartRevision] = {}

    def part(self, plant: Plant, cell: CellRun) -> CellPart:
        """The part of a cell as of the plant's last step; in one piece, as each cell of a view needs it."""
        known = self._known.get(cell.cell.name)
        if known is None or known.revision != plant.revisions[cell.cell.name]:
            return self._made_anew(plant, cell)
        robots, now = [], plant.now
        for row, belief, last in known.robots:
            aged, heard_at, command = row.copy(), belief.heard_at, row["command"]
            aged["age_s"] = None if heard_at is None else now - heard_at
            aged["telemetry_hz"] = belief.rate.hz if belief.online else None
            if last is not None and command is not None:
                aged["command"] = {**command, "age_s": now - last.sent_at}
            robots.append(aged)
        return CellPart(known.part.cell, robots, known.part.tasks)

    def _made_anew(self, plant: Plant, cell: CellRun) -> CellPart:
        """The part of a cell as it is now, remembered where it rests."""
        name, part = cell.cell.name, cell_part(plant, cell)
        self._known.pop(name, None)
        if _rests(plant, cell):
            robots = [_with_sources(plant, row) for row in part.robots]
            self._known[name] = PartRevision(revision=plant.revisions[name], part=part, robots=robots)
        return part


def _with_sources(plant: Plant, row: dict[str, Any]) -> tuple[dict[str, Any], Belief, Entry | None]:
    """A robot's row, with those that know its times."""
    dispatcher, name = plant.dispatcher, row["name"]
    return row, dispatcher.beliefs[name], dispatcher.ledger.last_sent.get(name)


def _rests(plant: Plant, cell: CellRun) -> bool:
    """True for an idle cell that shares nothing, while nothing of it has a time that passes."""
    shares = cell.cell.zone_users or cell.cell.interlocked or cell.cell.shared
    if cell.state is not CellState.IDLE or cell.tree is not None or shares:
        return False
    begun = any(task.started_at is not None for task in cell.queue)
    return not begun and not any(plant.dispatcher.ledger.of_robot(robot.name) for robot in cell.cell.robots)
