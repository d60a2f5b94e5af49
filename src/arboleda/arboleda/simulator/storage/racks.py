"""Record of the stations that have a part, by the tasks that put one there and by what operators took out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from arboleda.model.messages import OperatorAnswer, TaskState, Verb
from arboleda.recipes.storage_layout import StorageLayout

from ..recorded.scopes import Scopes
from ..recorded.tasks import KnownTask, Tasks

Stations = set[int]


class Racks:
    """Stations of each cell that are `full`, and those that may be, as a task began to fill them."""

    def __init__(self, cells: Iterable[StorageLayout], scopes: Scopes) -> None:
        self.cells = {cell.name: cell for cell in cells}
        self.full: dict[str, Stations] = {name: set() for name in self.cells}
        self._begun: dict[str, Stations] = {name: set() for name in self.cells}
        self._scopes = scopes
        self._emptied: dict[tuple[str, int], float] = {}

    def restart(self, kept: Mapping[str, str], running: Iterable[KnownTask]) -> None:
        """Begin anew with a plant that starts with what is kept of its racks."""
        for name in self.cells:
            self.full[name] = {int(number) for number in kept.get(name, "").split()}
            self._begun[name].clear()
        for task in running:
            if task.cell in self.cells:
                self._begin(task)

    def may_be_full(self, cell: str) -> Stations:
        return self.full[cell] | self._begun[cell]

    def look(self, tasks: Tasks, answers: Iterable[OperatorAnswer], now: float) -> None:
        """Take in what was done in a step."""
        for answer in answers:
            if answer.verb is Verb.UNLOAD and answer.refusal is None:
                self._empty(answer.scope, tasks, now)
        for change in tasks.changes:
            task = None if change.answer else tasks.known(change.said.task)
            if task is None or task.cell not in self.cells:
                continue
            if change.said.state is TaskState.RUNNING:
                self._begin(task)
            elif change.said.state is TaskState.DONE:
                self._end(task)

    def named(self, scope: str) -> dict[str, Stations]:
        """The stations of a scope, as `sis_a 7` or `sis_a`, by their cells; the scope may be any word."""
        name, _, station = scope.partition(" ")
        robots = self._scopes.robots(name)
        cells = [cell for cell in self.cells.values() if not {*cell.cell.holders}.isdisjoint(robots)]
        return {
            cell.name: {n for n in range(len(cell.stations)) if station in ("", str(n))} for cell in cells
        }

    def _begin(self, task: KnownTask) -> None:
        """Note for a task that begins the stations that may get its part, or get it back."""
        cell, filled = self.cells[task.cell], self._filled_by(task)
        pick = {n for n, station in enumerate(cell.stations) if station.name == cell.palletizing.pick.name}
        self._begun[task.cell] |= filled | pick

    def _end(self, task: KnownTask) -> None:
        """Note that a done task has filled its station, unless somebody emptied it since the task began."""
        for number in self._filled_by(task):
            if self._emptied.get((task.cell, number), -1.0) < (task.began or 0.0):
                self.full[task.cell].add(number)
                self._begun[task.cell].discard(number)

    def _empty(self, scope: str, tasks: Tasks, now: float) -> None:
        for cell, numbers in self.named(scope).items():
            self.full[cell] -= numbers
            self._begun[cell] -= numbers
            for number in numbers:
                self._emptied[cell, number] = now
            if cell in tasks.running:
                self._begin(tasks.open[tasks.running[cell]])

    def _filled_by(self, task: KnownTask) -> Stations:
        """The stations into which a task puts a part: one, or none."""
        cell, last = self.cells[task.cell], task.said.text.split()[-1]
        if last != "palletizing":
            return {int(last)}
        place = cell.palletizing.place.name
        return {number for number, station in enumerate(cell.stations) if station.name == place}
