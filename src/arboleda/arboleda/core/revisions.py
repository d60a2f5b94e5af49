"""Versions of the plant while it runs: each cell takes the version that was put to work once it rests."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from arboleda.model.errors import TextError
from arboleda.model.messages import CellRevised, Journal, Revision, RevisionAnswer
from arboleda.model.outside import plain
from arboleda.model.plant_model import PlantModel
from arboleda.model.revision import obstacle, revised
from arboleda.model.sentence import Phrase, Sentence

from .cell import CellRun, NextVersion
from .intake import gone
from .operator import PUT_TO_WORK
from .plant_state import PlantState

UNKNOWN_VERSION = Phrase("revision.unknown", "the plant has no version {number}")
NOT_WHILE_IT_RUNS = Phrase("revision.refused", "a plant that runs cannot take version {number}: {why}")
CHANGES_TOLD = 20  # in the journal; the version has all of them


class Revisions:
    """Versions that can be put to work, by digest; `use` makes another model that of the plant."""

    def __init__(
        self, state: PlantState, versions: dict[str, PlantModel], use: Callable[[PlantModel], None]
    ) -> None:
        self._state = state
        self._versions = versions
        self._use = use

    def take(self, event: Revision) -> None:
        """Have each cell take another version once it rests. Tasks that wait are read by it at once."""
        self._state.news.changes += 1
        version, number = event.version, event.version.number
        model, present = self._versions.get(version.digest), self._state.dispatcher.model
        if model is None:
            self._refuse(event, UNKNOWN_VERSION(number=number))
            return
        if (why := obstacle(present, model)) is not None:
            self._refuse(event, NOT_WHILE_IT_RUNS(number=number, why=why))
            return
        cells = tuple(map(revised, present.cells, model.cells))
        self._state.intake.put_last = version.digest
        self._state.dispatcher.outbox.append(_put_to_work(event))
        self._state.intake.model = replace(model, cells=cells)
        cancelled = [
            id for run in self._state.cells.values() for id in self._without_unfit(run, version.digest)
        ]
        for run, cell in zip(self._state.cells.values(), cells, strict=True):
            run.follow(NextVersion(version=version, cell=cell, timing=model.timing, taken=self._taken))
        self._use(replace(self._state.intake.model, cells=present.cells))
        busy = [(name, run) for name, run in self._state.cells.items() if not run.is_between_tasks]
        waits = tuple((name, run.task.id if run.task else "") for name, run in busy)
        self._state.dispatcher.outbox.append(
            RevisionAnswer(version=version, waits=waits, cancelled=tuple(cancelled), request=event.request)
        )

    def _refuse(self, event: Revision, why: Sentence) -> None:
        self._state.dispatcher.outbox.append(
            RevisionAnswer(version=event.version, refusal=why, request=event.request)
        )

    def _without_unfit(self, run: CellRun, version: str) -> list[str]:
        """Read the tasks that wait in a cell by this version; the ids of tasks that it does not take."""
        unfit = []
        for task in [*run.queue]:
            try:
                task.order = self._state.intake.still_allowed(task, version)
            except TextError as error:
                unfit.append(task.id)
                run.queue.drop(task, gone(error.sentence))
        return unfit

    def _taken(self, taken: NextVersion) -> None:
        name, present = taken.cell.name, self._state.dispatcher.model
        cells = tuple(taken.cell if cell.name == name else cell for cell in present.cells)
        self._use(replace(present, cells=cells))
        self._state.news.revised.add(name)
        self._state.news.changes += 1
        self._state.dispatcher.outbox.append(CellRevised(cell=name, version=taken.version))


def _put_to_work(event: Revision) -> Journal:
    lines = tuple(map(plain, event.changes[:CHANGES_TOLD]))
    untold = len(event.changes) - len(lines)
    changes = (*lines, *((f"... ({untold})",) if untold else ())) or ("-",)
    by = plain(event.by) or "-"
    sentence = PUT_TO_WORK(number=event.version.number, by=by, changes=changes)
    return Journal(verb=None, scope="", cell=None, sentence=sentence)
