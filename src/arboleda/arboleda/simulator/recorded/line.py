"""The time line that the pages of a plant would show, snapshot after snapshot."""

from __future__ import annotations

from typing import Any

from arboleda.views.changes import changed
from arboleda.views.chronicle import Chronicle

Row = dict[str, Any]
UNIX_S = 1_700_000_000.0  # what the clock on the wall says where the plant's says 0


class TimeLine:
    """Takes in snapshots of one start of the plant; `told` is what a page has that hears only what is new."""

    def __init__(self) -> None:
        self.begin()

    def begin(self) -> None:
        """A plant starts, and so do its pages."""
        self.chronicle = Chronicle()
        self.told: Row = {}

    def see(self, shown: Row) -> None:
        self.chronicle.see(shown, UNIX_S + shown["at"])
        self.told |= changed(self.told, shown)

    def last(self, kind: str, subject: str) -> Row | None:
        """The last event about a subject."""
        events = reversed(self.chronicle.events)
        return next((each for each in events if (each["kind"], each["subject"]) == (kind, subject)), None)
