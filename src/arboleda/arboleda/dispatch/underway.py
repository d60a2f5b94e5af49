"""Commands that may still be on their way to a robot."""

from __future__ import annotations

from arboleda.model.commands import Command, Work
from arboleda.model.messages import Report
from arboleda.model.plant_model import Evidence, PlantModel, Robot

from .evidence import QUIET_S

PATIENCE_S = 1.0  # in which an arm that is heard, and hears us, names our last command
KEPT = 64  # commands per arm; whatever settles a later one settles those before it


class Unnamed:
    """How many commands left for each board that numbers them, and were not named by it yet.

    What proves that a command is done need not name it: a switch may already be as it was told. `ids` are
    theirs by robot, oldest first.
    """

    def __init__(self, model: PlantModel) -> None:
        robots = model.robots.values()
        self.ids: dict[str, list[str]] = {
            robot.name: [] for robot in robots if robot.evidence is Evidence.IDS
        }

    def left(self, command: Command) -> None:
        """A command leaves for its robot."""
        if (ids := self.ids.get(command.robot)) is not None:
            ids.append(command.id)
            del ids[:-KEPT]

    def hear(self, report: Report) -> None:
        """A robot reports, and may name commands."""
        if ids := self.ids.get(report.robot):
            _settle(ids, report)

    def of(self, robot: str) -> int:
        return len(self.ids.get(robot, ()))


class UnderWay:
    """The commands to each arm that shares zones, or is shared, that no report has settled.

    Until then the arm may carry out something that it has not heard yet, so where it stands does not prove
    that it stays there. An arm that tells command ids, and can be stopped, settles them by naming them.
    Commands reach a board in order, so one that it took settles all before it. One that was rejected settles
    only itself: the bridge may have kept it. Of any other arm only work counts; it is settled by its end, or
    once the arm was heard for as long as an answer may take. `ids` are theirs by robot, oldest first.
    """

    def __init__(self, model: PlantModel) -> None:
        names = (name for cell in model.cells for name in (*cell.zone_users, *cell.shared_movers))
        users = [model.robots[name] for name in names]
        self._naming = frozenset(robot.name for robot in users if _names_commands(robot))
        self._others = frozenset(robot.name for robot in users) - self._naming
        self.ids: dict[str, list[str]] = {}
        self._heard_since: dict[str, float] = {}  # since the last one left

    def left(self, command: Command) -> None:
        """A command leaves for its robot."""
        works = command.robot in self._others and isinstance(command, Work)
        if works or command.robot in self._naming:
            self.ids[command.robot] = [*self.ids.get(command.robot, ())[-KEPT:], command.id]
            self._heard_since.pop(command.robot, None)

    def hear(self, report: Report, now: float) -> None:
        """A robot reports, and may name commands."""
        ids = self.ids.get(report.robot)
        if ids is None:
            return
        heard_since = self._heard_since.setdefault(report.robot, now)
        if report.robot in self._others and now >= heard_since + QUIET_S:
            ids.clear()
        _settle(ids, report)
        if not ids:
            del self.ids[report.robot]

    def ended(self, command: Command) -> None:
        """A command is done, or its robot was seen to stand since it was cancelled."""
        if command.robot in self._others:
            self.ids.pop(command.robot, None)

    def is_overdue(self, robot: str, now: float) -> bool:
        """Whether one of them must have been lost."""
        waits = robot in self.ids and robot in self._naming
        return waits and now >= self._heard_since.get(robot, now) + PATIENCE_S


def _settle(ids: list[str], report: Report) -> None:
    """Take out those that a report names, and those that left before one that was taken."""
    for taken in (report.accepted, report.done):
        if taken in ids:
            del ids[: ids.index(taken) + 1]
    if report.rejected in ids:
        ids.remove(report.rejected)


def _names_commands(robot: Robot) -> bool:
    return robot.evidence is Evidence.IDS and robot.has_stop
