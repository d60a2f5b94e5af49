"""Homing at the start of a plant: robots whose plant file wants it are homed as soon as they are heard."""

from __future__ import annotations

from arboleda.dispatch.belief import Belief
from arboleda.model.cell_states import CellState
from arboleda.model.plant_model import PlantModel

from .operator import Operator


class HomingAtStart:
    """Homing of robots that are not homed yet; `robots` are those that wait for it.

    The robots of a cell that holds a task of an earlier start stay where they are.
    """

    def __init__(self, model: PlantModel, beliefs: dict[str, Belief], operator: Operator) -> None:
        held = (run for run in operator.scopes.cells.values() if run.task is not None)
        staying = {robot.name for run in held for robot in run.cell.robots}
        self.robots = {name for name, robot in model.robots.items() if robot.home_at_start} - staying
        self._beliefs = beliefs
        self._operator = operator

    def look(self, robot: str) -> None:
        """Home a robot that was heard, if its cell lets it."""
        belief = self._beliefs[robot]
        if not belief.answered or belief.homed is None:
            return
        run = self._operator.scopes.in_charge(robot)
        if run.state not in (CellState.IDLE, CellState.HELD) or run.manual.teaching is not None:
            return
        if belief.unhomed and self._operator.homing.not_free(frozenset([robot])):
            return
        self.robots.discard(robot)
        if belief.unhomed:
            self._operator.homing.home(robot)
