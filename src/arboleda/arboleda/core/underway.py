"""Commands that may still be on their way to an arm that shares zones."""

from __future__ import annotations

from .messages import Command, Report
from .model import Cell, Evidence, PlantModel

PATIENCE_S = 1.0  # in which an arm that is heard, and hears us, names our last command


class UnderWay:
    """The last command to each arm, until a report names it; only where the arm tells command ids.

    Until then the arm may carry out something that it has not heard yet, so where it stands does not prove
    that it stays there. Commands reach a board in order, so the last one settles all before it. `last` are
    their ids, by robot.
    """

    def __init__(self, model: PlantModel) -> None:
        self._watched = frozenset(cell.arm.name for cell in model.cells if _names_commands(cell))
        self.last: dict[str, str] = {}
        self._heard_since: dict[str, float] = {}  # since it left

    def left(self, command: Command) -> None:
        """A command leaves for its robot."""
        if command.robot in self._watched:
            self.last[command.robot] = command.id
            self._heard_since.pop(command.robot, None)

    def hear(self, report: Report, now: float) -> None:
        """A robot reports, and may name the last command."""
        last = self.last.get(report.robot)
        if last is None:
            return
        self._heard_since.setdefault(report.robot, now)
        if last in (report.accepted, report.done, report.rejected):
            del self.last[report.robot]

    def is_overdue(self, robot: str, now: float) -> bool:
        """Whether the last command must have been lost."""
        return robot in self.last and now >= self._heard_since.get(robot, now) + PATIENCE_S


def _names_commands(cell: Cell) -> bool:
    return bool(cell.zones) and cell.arm.evidence is Evidence.IDS and cell.arm.has_stop
