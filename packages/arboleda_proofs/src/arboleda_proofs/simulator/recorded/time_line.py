"""The time line that the pages of a plant would show, snapshot after snapshot.

`screens_show_what_is` finds by it a time line that says when an act was seen, not when it was done.
"""

from __future__ import annotations

from collections import deque
from typing import Any

from arboleda.views.changes import changed
from arboleda.views.chronicle import EVENTS, Chronicle

Row = dict[str, Any]
UNIX_S = 1_700_000_000.0  # what the clock on the wall says where the plant's says 0


class TimeLine:
    """Time line over one start of the plant; `received` is what a page has that receives only news.

    `last` is the last event about each kind and subject, also where the time line has forgotten it; `acts`
    are events of what operators did, `foreign` counts those of other nodes' commands. `whole`: no event was
    forgotten before it was seen here.
    """

    def __init__(self) -> None:
        self.begin()

    def begin(self) -> None:
        """Begin anew with a plant that starts, and with its pages."""
        self.received: Row = {}
        self.last: dict[tuple[str, str], Row] = {}
        self.acts: deque[Row] = deque(maxlen=EVENTS)
        self.foreign = 0
        self.whole = True
        self._chronicle = Chronicle()
        self._last_number = 0  # events

    def see(self, shown: Row) -> None:
        self._chronicle.see(shown, UNIX_S + shown["at"])
        self.received |= changed(self.received, shown)
        new = [each for each in self._chronicle.events if each["number"] > self._last_number]
        self.whole = self.whole and (not new or new[0]["number"] == self._last_number + 1)
        self._last_number += len(new)
        for event in new:
            self.last[event["kind"], event["subject"]] = event
            self.foreign += event["kind"] == "foreign"
            if event["kind"] == "operator":
                self.acts.append(event)
