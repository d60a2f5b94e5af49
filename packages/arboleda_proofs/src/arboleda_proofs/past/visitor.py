"""One browser on a record: the moment it looks at, and frames of that."""

from __future__ import annotations

import json
import logging
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from arboleda.dashboard.toolkit import Client
from arboleda.extension import ArboledaError, Face, Words
from arboleda.views.changes import changed

from .frame_queue import FrameQueue
from .moments import dated
from .side import Shown, Start

if TYPE_CHECKING:  # without a record, the libraries that read one are not needed
    from .past import Past

GO, STEP, FAILURE, TASK, LOOK, LEAVE, GROW = "go", "step", "failure", "task", "look", "leave", "grow"
LONGEST = 300  # characters of a name that a browser sends
LATEST = 2**53  # the integers that a browser's numbers can tell apart

log = logging.getLogger(__name__)


@dataclass(frozen=True, kw_only=True)
class Arrival:
    """The place of the record at which a page is opened: a moment, the end of the task whose page it is, else
    the last failure, of a cell if one is named. `epoch`: in the record of that start."""

    moment: int | None = None
    task: str | None = None
    at_its_end: bool = False
    cell: str | None = None
    epoch: int | None = None


class Event(Protocol):
    """Event of a script, with what it says."""

    args: Any


class Visitor:
    """Visitor: one open page. Its moment changes with each event at once; frames follow as they are made."""

    def __init__(
        self,
        client: Client,
        shown: Shown,
        turns: FrameQueue,
        words: Words,
        arrival: Arrival,
    ) -> None:
        self._client = client
        self._side = shown.side
        self._stills = shown.stills
        self._turns = turns
        self._words = words
        self._arrival = arrival
        self._past: Past | None = None
        self._starts: list[Start] = []
        self._moment = 0
        self._task = arrival.task
        self._shown: Face = {}
        self._drawn: dict[str, Any] = {}
        self._looks = False
        self._number = 0
        self._busy = self._again = False

    async def come(self) -> None:
        """Send everything to a page that was opened or is back."""
        self._shown, self._drawn = {}, {}
        if self._past is None:
            try:
                past, self._starts = await self._turns.take(self._opened)
            except ArboledaError as error:
                self._say(self._words.say(error.sentence))
                return
            self._past = past
            self._arrive(past)
        await self._show()

    def _opened(self) -> tuple[Past, list[Start]]:
        return self._side.past(self._arrival.epoch), self._side.starts()

    async def _grow(self) -> None:
        """Tell the page the end of the record as it grows, if it is still being written."""
        try:
            self._past = past = await self._turns.take(lambda: self._side.past(self._arrival.epoch))
        except ArboledaError as error:
            self._say(self._words.say(error.sentence))
            return
        span = _span(past)
        if self._shown and self._shown.get("past/span") != span:
            self._shown["past/span"] = span
            self._tell({"past/span": span})

    async def hear(self, event: Event) -> None:
        """Take one event of the page: [what, of, cell]; anything else is ignored."""
        args = event.args if isinstance(event.args, list) else [event.args]
        what, of, cell = [*args, None, None, None][:3]
        if self._past is None:
            return
        if what == GROW:
            await self._grow()
            return
        of_cell = cell if isinstance(cell, str) and cell else None
        if self._takes(self._past, what, of, of_cell):
            await self._show()

    def _takes(self, past: Past, what: Any, of: Any, cell: str | None) -> bool:
        """Take a request of the page; True if there is something else to show afterwards."""
        if what == GO and isinstance(of, int) and abs(of) < LATEST:
            self._moment = past.within(of)
        elif what in (STEP, FAILURE) and of in (1, -1):
            return self._step(past, of, failures=what == FAILURE, cell=cell)
        elif what == TASK and (of is None or (isinstance(of, str) and len(of) <= LONGEST)):
            self._task = of
        elif what in (LOOK, LEAVE):
            self._looks, self._drawn = what == LOOK, {}
        else:
            return False
        return True

    def _step(self, past: Past, way: int, *, failures: bool, cell: str | None) -> bool:
        found = past.step(self._moment, way=way, failures=failures, cell=cell)
        if found is None:
            where = "last" if way > 0 else "first"
            self._say(self._words(f"record.{where}_{'failure' if failures else 'event'}"))
            return False
        self._moment = found
        return True

    def _arrive(self, past: Past) -> None:
        """Go to the moment that the address names."""
        arrival = self._arrival
        if arrival.moment is not None:
            self._moment = past.within(arrival.moment)
            return
        of_task = arrival.task if arrival.at_its_end else None
        found = past.end_of(of_task) if of_task else past.last_failure(arrival.cell)
        if found is None:
            self._say(self._words("record.no_task" if of_task else "record.no_failure"))
        self._moment = past.ended if found is None else found

    async def _show(self) -> None:
        """Send frames until the last requested moment is shown; some of those before it are left out."""
        self._again = True
        if self._busy:
            return
        self._busy = True
        try:
            while self._again:
                self._again = False
                await self._frame(self._moment, self._task)
        except ArboledaError as error:
            self._say(self._words.say(error.sentence))
        except Exception as error:
            log.error("a frame of a record failed (%s: %s)", type(error).__name__, error)
            log.debug("the frame that failed, whole", exc_info=error)
            self._say(self._words("record.unreadable"))
        finally:
            self._busy = False

    async def _frame(self, moment: int, task: str | None) -> None:
        past = self._past
        assert past is not None
        looks = self._looks and self._stills.ready
        face, drawn = await self._turns.take(
            lambda: (
                past.face(moment, self._words.language, task),
                self._stills.at(past, moment) if looks else {},
            )
        )
        if looks:
            self._draw(changed(self._drawn, drawn))
            self._drawn = drawn
        face["past/span"] = _span(past)
        face["past/starts"] = self._choice()
        patch = changed(self._shown, face) | {"past/at": moment}
        self._shown = face
        self._tell(patch)

    def _choice(self) -> list[list[Any]]:
        """The records to choose from: the start of each, its name, and whether it is shown or can be."""
        shown = self._arrival.epoch
        rows = []
        for start in self._starts:
            label = dated(start.began).partition(".")[0]
            label = label if start.is_same else self._words("record.other_plant", when=label)
            is_shown = start.is_own if shown is None else start.epoch == shown
            rows.append([None if start.is_own else str(start.epoch), label, is_shown, start.is_same])
        return rows

    def _tell(self, patch: dict[str, Any]) -> None:
        self._number += 1
        self._client.run_javascript(f"arboleda.live({self._number}, {json.dumps(patch)})")

    def _draw(self, patch: dict[str, Any]) -> None:
        self._client.run_javascript(f"arboledaTwin.frame(0, {json.dumps(patch)})")

    def _say(self, sentence: str) -> None:
        self._client.run_javascript(f"arboleda.answer({json.dumps(sentence)}, false)")


def _span(past: Past) -> list[Any]:
    """The beginning and the end of the record, and its failures."""
    return [past.began, past.ended, past.marks()]
