"""The page's memory from one snapshot to the next, and the faces that it makes of it."""

from __future__ import annotations

from collections.abc import Callable
from itertools import takewhile
from typing import Any

from arboleda.store.task_rows import TaskRow
from arboleda.views.chronicle import Chronicle, is_failure

from .faces import Face, task, whole_page
from .faces.moment import Moment
from .tree_memory import EndedTree, TreeMemory
from .wording import words

Row = dict[str, Any]


def nothing_added(_: Moment) -> Face:
    """Face of a page to which packages add nothing."""
    return {}


class PageState:
    """Trees and events of a plant; pure: `see` each snapshot in order, then ask for a `face`, which has what
    is `added` to it."""

    def __init__(
        self, layout: Row, past_acts: list[Row], added: Callable[[Moment], Face] = nothing_added
    ) -> None:
        self.layout = layout
        self._added = added
        self.chronicle = Chronicle(past_acts)
        self.trees: dict[str, TreeMemory] = {cell["name"]: TreeMemory() for cell in layout["cells"]}
        self.ended: dict[str, EndedTree] = {}  # by task, while the snapshot shows it
        self._failed: set[str] = set()  # cells that have failed, also where that event is forgotten
        self._last_event = 0  # the number of the last event that was looked at
        self._offset_s: float | None = None  # unix s less the plant's clock, so that shown times stay put
        self._snapshot: Row | None = None

    def see(self, snapshot: Row, unix_s: float) -> None:
        """Take in one snapshot, made at `unix_s`."""
        if self._offset_s is None:
            self._offset_s = unix_s - snapshot["at"]
        at = snapshot["at"] + self._offset_s
        for cell in snapshot["cells"]:
            ended = self.trees[cell["name"]].see(cell, snapshot["tasks"], at)
            if ended is not None:
                self.ended[ended.task] = ended
        shown = {task["id"] for task in snapshot["tasks"]}
        self.ended = {id: tree for id, tree in self.ended.items() if id in shown}
        self.chronicle.see(snapshot, at)
        self._note_failures()
        self._snapshot = snapshot

    def _note_failures(self) -> None:
        newest = [
            *takewhile(lambda event: event["number"] > self._last_event, reversed(self.chronicle.events))
        ]
        self._last_event += len(newest)
        self._failed |= {event["cell"] for event in newest if is_failure(event)}

    def face(self, language: str, links: Row) -> Face:
        """The contents of a page in this language; empty before the first snapshot."""
        moment = self._moment(language, links)
        return {} if moment is None else self._added(moment) | whole_page.face(moment)

    def task_face(self, id: str, language: str, kept: TaskRow | None = None) -> Face:
        """The page of one task in this language, known or not; empty before the first snapshot.

        `kept` is its row in the history.
        """
        moment = self._moment(language, {})
        return {} if moment is None else task.face(moment, id, self.ended.get(id), kept)

    def _moment(self, language: str, links: Row) -> Moment | None:
        if self._snapshot is None or self._offset_s is None:
            return None
        return Moment(
            snapshot=self._snapshot,
            layout=self.layout,
            links=links,
            trees=self.trees,
            events=self.chronicle.events,
            words=words(language),
            unix_s=self._snapshot["at"] + self._offset_s,
            failed=self._failed,
        )
