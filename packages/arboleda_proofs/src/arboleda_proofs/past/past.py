"""A record as the page reads it: its moments, and the contents of the page at each of them."""

from __future__ import annotations

import threading
from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from functools import lru_cache, partial
from typing import Any

from arboleda.dashboard.faces import task, whole_page
from arboleda.extension import Face, Moment, words
from arboleda.views.chronicle import is_failure
from arboleda_proofs.playback.cell_history import followed
from arboleda_proofs.playback.views import Views

from . import still
from .moments import moment_of, nanoseconds, until_ns
from .tree_history import TreeHistory

SHOWN_EVENTS = 1000
MARKS = 500  # on the slider, at most; more could not be told apart
NO_LINKS: dict[str, Any] = {"broker": None, "ros": None, "refused": {}, "standbys": []}

Row = dict[str, Any]


class Past:
    """The moments of a record are ms of Unix time. For any thread; one at a time is served."""

    def __init__(self, views: Views, layout: Row) -> None:
        self._views = views
        self._layout = layout
        self._cells = [cell["name"] for cell in layout["cells"]]
        self._one = threading.Lock()
        self._take_in()

    def grow(self) -> None:
        """Take in the part of the record that was written since."""
        with self._one:
            if moment_of(self._views.ended_ns / 1e9) != self.ended:
                self._take_in()

    def _take_in(self) -> None:
        views = self._views
        self._events = list(views.events())
        self._happened_ns = [nanoseconds(each["at"]) for each in self._events]
        self._moments = lru_cache(None)(self._found)
        self._trees = TreeHistory(partial(followed, views), self._events, self._cells, views.began_ns)
        self.began, self.ended = moment_of(views.began_ns / 1e9), moment_of(views.ended_ns / 1e9)

    def failures(self, cell: str | None = None) -> Sequence[int]:
        """The moments at which a task failed or a cell was held by itself, of one cell or all."""
        return self._moments(cell, only_failures=True)

    def marks(self) -> list[int]:
        """The failures that a slider shows: no more than can be told apart, the last of those too near."""
        step = max(1, (self.ended - self.began) // MARKS)
        return list({(each - self.began) // step: each for each in self.failures()}.values())

    def step(self, moment: int, *, way: int, failures: bool, cell: str | None = None) -> int | None:
        """The next moment at which something happened, or the one before where `way` is negative."""
        found = self._moments(cell, only_failures=failures)
        if way > 0:
            later = found[bisect_right(found, moment) :]
            return later[0] if later else None
        before = found[: bisect_left(found, moment)]
        return before[-1] if before else None

    def last_failure(self, cell: str | None = None) -> int | None:
        found = self.failures(cell)
        return found[-1] if found else None

    def end_of(self, id: str) -> int | None:
        """The moment of the last event of a task, as a rule its end; None if the record has no such task."""
        mine = (each for each in reversed(self._events) if each["kind"] == "task" and each["subject"] == id)
        last = next(mine, None)
        return None if last is None else moment_of(last["at"])

    def within(self, moment: int) -> int:
        """It, or the nearest that is in the record."""
        return min(max(moment, self.began), self.ended)

    def face(self, moment: int, language: str, id: str | None = None) -> Face:
        """The contents of the page at a moment, with the page of a task if one is open."""
        with self._one:
            at_ns = until_ns(moment)
            then = self._then(at_ns, language)
            found = still.without_acts(whole_page.face(then)) | still.of_record(then, moment)
            found |= still.with_links(found, then.events)
            return found if id is None else found | still.without_acts(self._task(then, at_ns, id))

    def positions(self, moment: int) -> Row:
        """The positions that the twin shows at a moment, as `PageApi.positions` has it."""
        with self._one:
            return self._views.positions(until_ns(moment))

    def _then(self, at_ns: int, language: str) -> Moment:
        upto = bisect_right(self._happened_ns, at_ns)
        snapshot = self._views.at(at_ns)
        return Moment(
            snapshot=snapshot,
            layout=self._layout,
            links=NO_LINKS | self._views.links(at_ns),
            trees={cell: self._trees.at(cell, at_ns, snapshot) for cell in self._cells},
            events=self._events[max(0, upto - SHOWN_EVENTS) : upto],
            words=words(language),
            unix_s=at_ns / 1e9,
            failed={each["cell"] for each in self._events if is_failure(each)},
        )

    def _task(self, then: Moment, at_ns: int, id: str) -> Face:
        return task.face(then, id, self._trees.ended(id, at_ns))

    def _found(self, cell: str | None, *, only_failures: bool) -> list[int]:
        """The moments at which something happened."""
        mine = (each for each in self._events if cell in (None, each["cell"]))
        return sorted({moment_of(each["at"]) for each in mine if not only_failures or is_failure(each)})
