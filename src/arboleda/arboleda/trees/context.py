"""Context of a cell's trees: one facet for each thing that their leaves may touch."""

from __future__ import annotations

from collections.abc import Callable

from py_trees.behaviour import Behaviour

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.obstacles import Barrier
from arboleda.dispatch.zones import Zones
from arboleda.model.messages import Failure, Notice, TaskAnswer
from arboleda.model.plant_model import Cell, Timing

from .cell_commands import CellCommands
from .cell_devices import CellDevices
from .cell_robots import CellRobots
from .cell_time import CellTime, Clock
from .cell_zones import CellZones
from .failures import Failures
from .handling import Handling
from .needs import CellNeeds
from .part_places import Places
from .parts import Parts
from .piece_sensors import PieceSensors

MOST_ANSWERS = 100  # that are kept of a task


class Context:
    """Facets of one cell, and what concerns several of them. A recipe sees `Kit` alone.

    `answers` are the answers to the task that runs.
    """

    def __init__(
        self,
        cell: Cell,
        dispatcher: Dispatcher,
        zones: Zones,
        clock: Clock,
        at_work: Callable[[str], bool],
    ) -> None:
        self.cell = cell
        self.timing: Timing = dispatcher.limits.timings[cell.name]
        self.time = CellTime(clock)
        self.devices = CellDevices(cell, dispatcher, zones)
        self.robots = CellRobots(cell, dispatcher, self.time, self.devices)
        self.sensors = PieceSensors(dispatcher.beliefs, self.timing, self.time)
        self.parts = Parts(cell, dispatcher, self.devices, self.robots, self.sensors)
        self.zones = CellZones(cell, dispatcher, zones, self.devices, self.robots, self.parts, at_work)
        self.places = Places(cell, dispatcher, self.robots, self.devices)
        self.commands = CellCommands(cell.name, dispatcher, self.time, self._guards(cell, dispatcher))
        self.failures = Failures(self.parts)
        self.handling = Handling(dispatcher.beliefs)
        self.answers: list[TaskAnswer] = []
        self._dispatcher = dispatcher
        self._outbox = dispatcher.outbox

    def revise(self, cell: Cell, timing: Timing) -> None:
        """Go by another version of the cell from now on; only where no tree runs and no command is open."""
        self.cell, self.timing = cell, timing
        for facet in (self.devices, self.robots, self.parts, self.zones, self.places):
            facet.revise(cell)
        self.sensors.revise(timing)
        self._dispatcher.limits.timings[cell.name] = timing

    def _guards(self, cell: Cell, dispatcher: Dispatcher) -> list[Barrier]:
        """The guards that may ever object to a command; no version changes what they look at."""
        guards = (
            (cell.shared, self.devices.objection),
            (cell.needs, CellNeeds(cell, dispatcher).objection),
            (cell.places, self.places.objection),
            (cell.interlocks or cell.zone_users, self.zones.objection),
        )
        return [objection for applies, objection in guards if applies]

    def start_afresh(self) -> None:
        """Forget the waits and failures of the last tree."""
        self.sensors.awaited = False
        self.commands.used = set()
        self.handling.begin()
        self.parts.begin()
        self.failures.clear()
        self.time.forget_wakes()

    def settle(self) -> None:
        """Believe the reports of effectors that an earlier start was switching."""
        self.parts.settle()

    def note(self, answer: TaskAnswer) -> None:
        """Keep an answer with the task that runs; only the last MOST_ANSWERS stay."""
        self.answers.append(answer)
        del self.answers[:-MOST_ANSWERS]

    def notify(self, notice: Notice) -> None:
        """Tell the outside."""
        self._outbox.append(notice)

    def wake_at(self, at: float) -> None:
        """Former name of `time.wake_at`, for leaves of one's own; it goes with version 0.3."""
        self.time.wake_at(at)

    def fail(self, failure: Failure, leaf: Behaviour | None = None) -> None:
        """Former name of `failures.add`, for leaves of one's own; it goes with version 0.3."""
        self.failures.add(failure, leaf)
