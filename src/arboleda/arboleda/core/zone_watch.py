"""Watch over zones and shared devices: who is in them, by what is heard, and who gives them back."""

from __future__ import annotations

from functools import partial
from itertools import filterfalse

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.zones import Zones
from arboleda.model.cell_states import CellState

from .cell import CellRun
from .cell_guard import CellGuard


class ZoneWatch:
    """Watch over the zones of a plant; `interlocked` are the devices that may occupy some, with their cell.

    Of what cells share that is the first of them.
    """

    def __init__(
        self, cells: dict[str, CellRun], dispatcher: Dispatcher, zones: Zones, guard: CellGuard
    ) -> None:
        self.interlocked = [
            (run, device)
            for name, run in cells.items()
            for device in run.cell.interlocked
            if dispatcher.model.cell_of[device].name == name
        ]
        self._cells = cells
        self._dispatcher = dispatcher
        self._zones = zones
        self._guard = guard

    def follow_interlocks(self) -> None:
        """Have devices occupy and leave zones as they say how they stand."""
        for run, device in self.interlocked:
            self._guard.run(run.cell.name, partial(run.context.zones.follow, device))

    def look(self) -> None:
        """Look who is in zones, and has shared devices."""
        inside = self._zones.robots
        for name, cell in self._cells.items() if inside else ():
            # One that cells share may have homed for a cell without zones, and held those of another.
            movers = filter(cell.context.devices.answers_for, cell.cell.workspaces)
            machines = filterfalse(cell.context.devices.is_lent, cell.cell.interlocked)
            for robot in (*movers, *machines):
                if robot in inside:
                    self._guard.run(name, partial(self._look_at, cell, robot))
        self.give_back_shared()

    def give_back_shared(self) -> None:
        """Give back the shared devices that an idle cell still holds; it keeps those that are silent."""
        for device in self._dispatcher.model.shared:
            holder = self._cells.get(self._zones.holder(device) or "")
            if holder is not None:
                # a cell that is held, stopped or taught keeps what it has
                ended = holder.state is CellState.IDLE and holder.manual.teaching is None
                keep = partial(holder.context.devices.keep, device, ended=ended)
                self._guard.run(holder.cell.name, keep)

    def _look_at(self, cell: CellRun, robot: str) -> None:
        """A robot that is not heard may still be where it was; one that is seen outside is not."""
        belief = self._dispatcher.beliefs[robot]
        if not belief.online or belief.unhomed:
            self._zones.quarantine(robot)
        elif cell.manual.teaching is None and (
            cell.tree is None or cell.stranded
        ):  # no step of it needs them any more
            cell.context.zones.leave(robot)
