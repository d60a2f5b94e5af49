"""Stops of operators at robots and cells, from the stop until clear and reset, over all starts.

`verbs_do_what_they_say` finds by it a cell that is cleared with one of its robots.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from arboleda.drivers import Stop, StopMode
from arboleda.model.cell_states import CellState
from arboleda.model.messages import OperatorRequest, Verb
from arboleda.model.plant_model import PlantModel

from .cells import KnownCell
from .operator_requests import NO_VERBS
from .robots import STOPS, KnownRobot, StopProgress
from .scopes import Scopes


class OperatorStops:
    """Keeps `stop` of each robot and `stopped` of each cell; `lost`: stopped robots, of which the plant that
    starts knows nothing.
    """

    def __init__(
        self, model: PlantModel, scopes: Scopes, robots: dict[str, KnownRobot], cells: dict[str, KnownCell]
    ) -> None:
        self.lost: list[str] = []
        self._model = model
        self._scopes = scopes
        self._robots = robots
        self._cells = cells

    def stop(self, scope: str) -> None:
        for name in self._scopes.commanded(scope):
            self._robots[name].stop = StopProgress.LATCHED
        for name in self._scopes.cells(scope):
            self._cells[name].stopped = True

    def clear(self, known: KnownRobot) -> None:
        """Take in that the plant clears a robot."""
        known.barred = False
        known.stop = StopProgress.CLEARED if known.stop is StopProgress.LATCHED else known.stop

    def reset(self, scope: str) -> None:
        for name in self._scopes.cells(scope):
            cell = self._cells[name]
            if cell.state is CellState.STOPPED:
                cell.stopped = False
                for robot in cell.cell.robots:  # a shared device only with the last of its cells
                    cells = self._model.cells_of[robot.name]
                    if not any(self._cells[each.name].stopped for each in cells):
                        self._robots[robot.name].stop = None

    def missed(self, command: Stop, known: KnownRobot, verbs: frozenset[Verb], now: float) -> frozenset[Verb]:
        """Count a clear once more when a robot that was offline at that time is back."""
        missed, asked = known.missed_clear, Verb.CLEAR in verbs
        known.missed_clear = command.mode is StopMode.CLEAR and asked and known.offline(now)
        known.missed_clear |= command.mode is StopMode.HALT and missed
        return frozenset({Verb.CLEAR}) if missed else NO_VERBS

    def find(self, kept: Mapping[str, str], last: Iterable[OperatorRequest]) -> None:
        """Look which stops are on the disk of a plant that has died; `last`: what it was asked as it died."""
        stopped = [name for name, known in self._robots.items() if known.stop is StopProgress.LATCHED]
        undone = any(each.verb in (Verb.CLEAR, Verb.RESET) for each in last)
        self.lost = [name for name in stopped if kept.get(name) != "on" and not undone]

    def take_over(self, kept: Mapping[str, str]) -> None:
        """Take over the stops on the disk: of a step in which the plant died, they show how far it got."""
        for name in self._scopes.commanded(""):
            self._robots[name].stop = STOPS.get(kept.get(name, ""))
        for cell in self._cells.values():
            alone = [
                name
                for name in cell.cell.shared
                if kept.keys().isdisjoint(own for each in self._model.cells_of[name] for own in each.own)
            ]
            cell.stopped = not kept.keys().isdisjoint((*cell.cell.own, *alone))
