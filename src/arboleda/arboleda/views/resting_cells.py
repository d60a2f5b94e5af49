"""Parts of views for cells to which nothing has happened, kept from one view to the next."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from arboleda.engine import Belief, CellRun, Entry, Plant

from . import tree_view
from .view import CellPart, cell_part, elapsed_s, left_s, teaching


@dataclass(frozen=True, kw_only=True)
class PartRevision:
    """A part as of one revision of its cell, with the sources of the times in it.

    `has_times` is False for the row of a cell in which no time passes: then all views have it as it is.
    """

    revision: int
    part: CellPart
    robots: list[tuple[dict[str, Any], Belief, Entry | None]]
    has_times: bool


class RestingCells:
    """Parts of one plant's views: made anew only for cells whose revision is not that of the view before.

    Their times and rates of reports are of now in every view. A cell that shares something is always made
    anew: what it waits for may be with any other cell. The rows of two views may be the same objects, so
    nobody may change them.
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
            if row["question"] is not None and (asked := plant.dispatcher.ledger.question(row["name"])):
                aged["question"] = {**row["question"], "left_s": left_s(asked, now)}
            robots.append(aged)
        if not known.has_times:
            return CellPart(known.part.cell, robots, known.part.tasks)
        tasks = _aged_tasks(plant, known.part.tasks)
        return CellPart(_aged(plant, cell, known.part.cell), robots, tasks)

    def _made_anew(self, plant: Plant, cell: CellRun) -> CellPart:
        """The part of a cell as it is now, remembered where the cell shares nothing."""
        name, part = cell.cell.name, cell_part(plant, cell)
        self._known.pop(name, None)
        if not (cell.cell.zone_users or cell.cell.interlocked or cell.cell.shared):
            begun = any(row["started_at"] is not None for row in part.tasks.values())
            self._known[name] = PartRevision(
                revision=plant.revisions[name],
                part=part,
                robots=[_with_sources(plant, row) for row in part.robots],
                has_times=begun or cell.tree is not None or cell.manual.teaching is not None,
            )
        return part


def _with_sources(plant: Plant, row: dict[str, Any]) -> tuple[dict[str, Any], Belief, Entry | None]:
    """A robot's row, with those that know its times."""
    dispatcher, name = plant.dispatcher, row["name"]
    return row, dispatcher.beliefs[name], dispatcher.ledger.last_sent.get(name)


def _aged(plant: Plant, cell: CellRun, row: dict[str, Any]) -> dict[str, Any]:
    """The row of a cell with the times of now."""
    aged, task, now = row.copy(), cell.task, plant.now
    if cell.tree is not None:
        aged["tree"] = tree_view.aged(cell.tree, row["tree"], now)
    if task is not None:
        aged["task"] = {**row["task"], "elapsed_s": elapsed_s(task, now)}
    aged["teaching"] = teaching(plant, cell)
    return aged


def _aged_tasks(plant: Plant, tasks: dict[str, dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """The rows of open tasks with the times of now."""
    now, known = plant.now, plant.intake.tasks
    return {id: {**row, "elapsed_s": elapsed_s(known[id], now)} for id, row in tasks.items()}
