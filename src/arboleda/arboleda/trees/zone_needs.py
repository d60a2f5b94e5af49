"""Needs of zones: the zones that a robot, or a machine, has to hold for its next moves."""

from __future__ import annotations

from arboleda.dispatch.whereabouts import Whereabouts
from arboleda.model import zone_plan
from arboleda.model.commands import Command, Motion
from arboleda.model.plant_model import Cell, Pose

from .cell_robots import CellRobots
from .parts import Parts


class ZoneNeeds:
    """Needs of zones by where the robots of one cell are, and where their parts belong."""

    def __init__(self, cell: Cell, whereabouts: Whereabouts, robots: CellRobots, parts: Parts) -> None:
        self._cell = cell
        self._whereabouts = whereabouts
        self._robots = robots
        self._parts = parts

    def revise(self, cell: Cell) -> None:
        """Go by another version of the cell from now on."""
        self._cell = cell

    def between(self, robot: str, *goals: Pose) -> frozenset[str]:
        """The zones on the way of a robot to each of these poses, from wherever it is."""
        space, here = self._cell.reach[robot], self._robots.position(robot)
        return frozenset[str]().union(*(zone_plan.passed(space, here, goal.q) for goal in goals))

    def for_recovery(self, robot: str) -> frozenset[str]:
        """The zones that a recovery needs on its way, from where the robot stands now."""
        space = self._cell.workspaces[robot]
        place, back = self._whereabouts.place(space), self._parts.way_back(robot)
        between = self.between(robot, *((back,) if back else ()), space.home)
        return zone_plan.recovery_zones(space, place, back) | between

    def of(self, command: Command) -> frozenset[str]:
        """The zones that its robot has to hold for a command."""
        space = self._cell.workspaces.get(command.robot)
        if space is not None and isinstance(command, Motion) and command.way:
            if not space.zones:
                return space.zones
            return zone_plan.entered(space, self._whereabouts.place(space), command.way)
        if not self._cell.interlocks:
            return frozenset()
        locks = self._cell.interlocks_of(command.robot)
        return frozenset(each.zone for each in locks if each.is_ended_by(command))
