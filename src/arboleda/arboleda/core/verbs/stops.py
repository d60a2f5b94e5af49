"""Stops (software) on an operator's word: latches robots, clears them, and resets their cells."""

from __future__ import annotations

from arboleda.model.cell_states import Cause, CellState
from arboleda.model.sentence import Phrase, Sentence

from .. import cell_steps
from ..cell import CellRun
from ..plant_state import PlantState

STAYS_STOPPED = Phrase(
    "refusal.stays_stopped", "{device} stays stopped while {cells} is; clear {cells} first"
)
ONLY_ABORTED = Phrase("refusal.only_aborted", "{cell} is {state}; only an aborted cell can be cleared")
NOT_STILL = Phrase("refusal.not_still", "{robots} is not still yet")
CLEAR_FIRST = Phrase("refusal.clear_first", "{cell} is not cleared after its stop yet; clear {cell} first")
NOT_STOPPED = Phrase(
    "refusal.not_stopped", "{cell} is {state}; a cell is reset after a stop, once it has been cleared"
)
STOPPING = (CellState.ABORTING, CellState.ABORTED)
UNTIL_RESET = (*STOPPING, CellState.CLEARING, CellState.STOPPED)


class Stops:
    """Stops of robots in their cells. A shared device stays stopped as long as one of its cells is."""

    def __init__(self, state: PlantState) -> None:
        self._state = state

    def latch(self, cell: CellRun, robots: frozenset[str]) -> None:
        """Latch the robots of a cell: they stand, and take no command, until they are cleared."""
        for robot in cell.cell.robots:
            if robot.name in robots:
                self._state.dispatcher.latches.latch(robot.name)

    def not_clearable(self, cell: CellRun, robots: frozenset[str]) -> Sentence | None:
        """The reason why robots of a cell cannot be cleared."""
        if cell.state not in (CellState.ABORTED, CellState.CLEARING):
            return ONLY_ABORTED(cell=cell.cell.name, state=cell.state.sentence)
        others = self._kept_stopped(cell, robots)
        if others and others.keys() >= {each.name for each in cell.cell.robots if each.name in robots}:
            device, cells = next(iter(others.items()))
            return STAYS_STOPPED(device=device, cells=cells)
        finishes = self._state.dispatcher.ledger.finishes
        mine = [each.name for each in cell.cell.robots if each.name in robots and not finishes(each.name)]
        beliefs = [self._state.dispatcher.beliefs[name] for name in mine]
        online = [belief for belief in beliefs if belief.online]
        moving = tuple(belief.robot.name for belief in online if not belief.stillness.is_still)
        return NOT_STILL(robots=moving) if moving else None

    def clear(self, cell: CellRun, robots: frozenset[str]) -> None:
        """Clear robots of a cell; clear the cell once none of its robots is stopped."""
        stay_stopped = self._kept_stopped(cell, robots.union(cell.cell.shared))
        was_stopped = cell.context.devices.is_stopped  # also if it was cleared: the clear may have got lost
        unstopped = {name for name in cell.cell.shared if not was_stopped(name)}
        for robot in cell.cell.robots:
            if robot.name in robots - unstopped and robot.name not in stay_stopped:
                self._state.dispatcher.latches.unlatch(robot.name)
        stopped = self._state.dispatcher.latches.stopped - stay_stopped.keys()
        if not any(robot.name in stopped for robot in cell.cell.robots):
            cell_steps.clear(cell)

    def _kept_stopped(self, cell: CellRun, robots: frozenset[str]) -> dict[str, tuple[str, ...]]:
        """The robots that stay stopped when they are cleared in a cell, each with the cells that keep it so.

        Such a cell shares the robot, was stopped too, and is not cleared with it.
        """
        stay_stopped, stopped = {}, self._state.dispatcher.latches.stopped - robots
        for name in cell.cell.shared:
            cells = [each for each in self._state.dispatcher.model.cells_of[name] if stopped & {*each.own}]
            others = tuple(each.name for each in cells if self._state.cells[each.name].state in STOPPING)
            if name in robots and name in self._state.dispatcher.latches.stopped and others:
                stay_stopped[name] = others
        return stay_stopped

    def reset(self, cell: CellRun, robots: frozenset[str]) -> None:
        """End the stop of a cell that was cleared; a shared device waits for the reset of all its cells."""
        for robot in cell.cell.robots:
            others = [
                each for each in self._state.dispatcher.model.cells_of[robot.name] if each is not cell.cell
            ]
            if not any(self._state.cells[other.name].state in UNTIL_RESET for other in others):
                self._state.dispatcher.latches.forget(robot.name)
        cell.become(Cause.RESET)
        cell.become(Cause.READY)


def not_resettable(cell: CellRun, robots: frozenset[str]) -> Sentence | None:
    """The reason why a cell cannot be reset."""
    if cell.state is CellState.STOPPED:
        return None
    if cell.state in STOPPING:
        return CLEAR_FIRST(cell=cell.cell.name)
    return NOT_STOPPED(cell=cell.cell.name, state=cell.state.sentence)
