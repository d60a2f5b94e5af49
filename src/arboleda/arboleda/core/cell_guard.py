"""Guard of the cells: what raises in one of them holds that cell, and nothing else."""

from __future__ import annotations

from collections.abc import Callable

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.model.messages import Failure, InternalError, Reason
from arboleda.model.outside import plain
from arboleda.model.sentence import Phrase, Sentence

from .cell import CellRun
from .news import News

BROKE_IN_STEP = Phrase("cell.broke_in_step", "{cell}: {kind} in a step: {error}")


class CellGuard:
    """Guard of the cells; `told` has the last error of each cell since the last request of anybody."""

    def __init__(
        self, cells: dict[str, CellRun], dispatcher: Dispatcher, news: News, clock: Callable[[], float]
    ) -> None:
        self.told: dict[str, Sentence] = {}
        self._cells = cells
        self._dispatcher = dispatcher
        self._news = news
        self._clock = clock

    def run(self, cell: str, act: Callable[[], None]) -> None:
        """Do something for one cell; where it raises, that cell breaks down and no other."""
        try:
            act()
        except Exception as error:  # noqa: BLE001 - whatever it is, it ends the work of this cell, not the plant
            self.break_down(cell, error)

    def break_down(self, cell: str, error: Exception) -> None:
        """Hold a cell in which something raised. An equal error is told once until the next request."""
        self._news.changes += 1
        self._news.revised.add(cell)
        text = plain(" ".join(str(error).split()))
        sentence = BROKE_IN_STEP(cell=cell, kind=type(error).__name__, error=text)
        failure = Failure(reason=Reason.INTERNAL, sentence=sentence)
        if self.told.get(cell) != sentence:
            self.told[cell] = sentence
            self._dispatcher.outbox.append(InternalError(cell=cell, error=error))
        self._dispatcher.booking.give_up(cell, failure, self._clock())
        self._cells[cell].break_down(failure)
