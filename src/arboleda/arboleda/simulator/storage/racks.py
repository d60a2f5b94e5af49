"""Record of the stations that have a part, by the tasks that put one there and by what operators took out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from arboleda.model.messages import OperatorAnswer, TaskState, Verb
from arboleda.model.plant_model import PlantModel
from arboleda.recipes.storage_layout import StorageLayout

from ..recorded.scopes import Scopes
from ..recorded.tasks import KnownTask, Tasks
from .tasks import is_storage_task, stores

Stations = set[int]


class Racks:
    """Stations of each cell that are `full`, and those that may be, as a task began to fill them.

    `of_others`: the cells at a task of another recipe, and until the next one of storage; what those leave in
    a rack is taken over then.
    """

    def __init__(self, model: PlantModel, scopes: Scopes) -> None:
        self.cells = {cell.name: StorageLayout(cell) for cell in model.cells if stores(cell)}
        self.of_others: set[str] = set()
        self._model = model
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
                self._begin(task, kept)

    def may_be_full(self, cell: str) -> Stations:
        return self.full[cell] | self._begun[cell]

    def look(
        self, tasks: Tasks, answers: Iterable[OperatorAnswer], kept: Mapping[str, str], now: float
    ) -> None:
        """Take in what was done in a step."""
        for answer in answers:
            if answer.verb is Verb.UNLOAD and answer.refusal is None:
                self._empty(answer.scope, tasks, kept, now)
        for change in tasks.changes:
            task = None if change.answer else tasks.known(change.said.task)
            if task is None or task.cell not in self.cells:
                continue
            if change.said.state is TaskState.RUNNING:
                self._begin(task, kept)
            elif change.said.state is TaskState.DONE and task.cell not in self.of_others:
                self._end(task)

    def named(self, scope: str) -> dict[str, Stations]:
        """The stations of a scope, as `sis_a 7` or `sis_a`, by their cells; the scope may be any word."""
        name, _, station = scope.partition(" ")
        robots = self._scopes.robots(name)
        racks = [cell for cell in self._model.cells if cell.stations]
        cells = [cell for cell in racks if not {*cell.holders}.isdisjoint(robots)]
        return {
            cell.name: {n for n in range(len(cell.stations)) if station in ("", str(n))} for cell in cells
        }

    def _begin(self, task: KnownTask, kept: Mapping[str, str]) -> None:
        """Note for a task that begins the stations that may get its part, or get it back."""
        cell = self.cells[task.cell]
        if not is_storage_task(cell.cell, task.said.text):
            self.of_others.add(task.cell)
            return
        if task.cell in self.of_others:
            self.of_others.discard(task.cell)
            self.full[task.cell] = {int(number) for number in kept.get(task.cell, "").split()}
            self._begun[task.cell].clear()
        filled = self._filled_by(task)
        pick = {n for n, station in enumerate(cell.stations) if station.name == cell.palletizing.pick.name}
        self._begun[task.cell] |= filled | pick

    def _end(self, task: KnownTask) -> None:
        """Note that a done task has filled its station, unless somebody emptied it since the task began."""
        for number in self._filled_by(task):
            if self._emptied.get((task.cell, number), -1.0) < (task.began or 0.0):
                self.full[task.cell].add(number)
                self._begun[task.cell].discard(number)

    def _empty(self, scope: str, tasks: Tasks, kept: Mapping[str, str], now: float) -> None:
        for cell, numbers in self.named(scope).items():
            if cell not in self.cells:
                continue
            self.full[cell] -= numbers
            self._begun[cell] -= numbers
            for number in numbers:
                self._emptied[cell, number] = now
            if cell in tasks.running:
                self._begin(tasks.open[tasks.running[cell]], kept)

    def _filled_by(self, task: KnownTask) -> Stations:
        """The stations into which a task puts a part: one, or none."""
        cell, last = self.cells[task.cell], task.said.text.split()[-1]
        if last != "palletizing":
            return {int(last)}
        place = cell.palletizing.place.name
        return {number for number, station in enumerate(cell.stations) if station.name == place}
