"""Watch over zones and shared devices: which robots reports show in them, and when they are given back."""

from __future__ import annotations

from functools import partial
from itertools import filterfalse

from arboleda.model.cell_states import CellState

from .cell import CellRun
from .cell_guard import CellGuard
from .plant_state import PlantState


class ZoneWatch:
    """Watch over the zones of a plant.

    `interlocked` has each device that may occupy zones, with its cell; a shared device with its first cell.
    """

    def __init__(self, state: PlantState, guard: CellGuard) -> None:
        self.interlocked = [
            (run, device)
            for name, run in state.cells.items()
            for device in run.cell.interlocked
            if state.dispatcher.model.cell_of[device].name == name
        ]
        self._state = state
        self._guard = guard

    def follow_interlocks(self) -> None:
        """Have devices occupy and leave zones as their reports say."""
        for run, device in self.interlocked:
            self._guard.run(run.cell.name, partial(run.context.zones.follow, device))

    def look(self) -> None:
        """Quarantine or give back the zones of robots, then shared devices."""
        inside = self._state.zones.robots
        for name, cell in self._state.cells.items() if inside else ():
            # A shared robot may home for a cell without zones, and holds those of its other cells meanwhile.
            movers = filter(inside.__contains__, cell.cell.workspaces)
            machines = filter(inside.__contains__, cell.cell.interlocked)
            devices = cell.context.devices
            for robot in (*filter(devices.answers_for, movers), *filterfalse(devices.is_lent, machines)):
                self._guard.run(name, partial(self._look_at, cell, robot))
        self.give_back_shared()

    def give_back_shared(self) -> None:
        """Give back shared devices that idle cells hold; a silent device stays with its cell."""
        for device in self._state.dispatcher.model.shared:
            holder = self._state.cells.get(self._state.zones.holder(device) or "")
            if holder is not None:
                # a cell that is held, stopped or taught keeps its devices
                ended = holder.state is CellState.IDLE and holder.manual.teaching is None
                keep = partial(holder.context.devices.keep, device, ended=ended)
                self._guard.run(holder.cell.name, keep)

    def _look_at(self, cell: CellRun, robot: str) -> None:
        """Quarantine the zones of a robot whose place is unknown: it may still be in them.

        Others are given back once no step of the cell's task can need them, and the robot is seen outside.
        """
        belief = self._state.dispatcher.beliefs[robot]
        if not belief.online or belief.unhomed:
            self._state.zones.quarantine(robot)
        elif cell.manual.teaching is None and (cell.tree is None or cell.stranded):
            cell.context.zones.leave(robot)
