"""Has the twin drawn by every browser that looks at it, and does nothing while none does."""

from __future__ import annotations

import asyncio
import json
import logging
from typing import Any, Protocol

from arboleda.views.changes import changed

from ..page_api import PageApi
from .twin import Twin

FRAMES_HZ = 20.0
BEHIND = 20  # frames that a browser may not have drawn yet; it gets no more before it has

log = logging.getLogger(__name__)


class TwinViewer(Protocol):
    """One browser that looks."""

    @property
    def connected(self) -> bool: ...

    def draw(self, number: int, patch: str) -> None:
        """Send one frame: its number from 1 on, and what changed as JSON."""


class ViewerProgress:
    """How far one looker is: how many frames were sent to it, and how many of them it has drawn."""

    def __init__(self) -> None:
        self.whole = True  # it has to be told everything
        self.sent = 0
        self.drawn = 0


class Show:
    """`look` and `leave` for browsers, `run` in the server's event loop."""

    def __init__(self, plant: PageApi) -> None:
        self._plant = plant
        self._twin: Twin | None = None
        self._lookers: dict[TwinViewer, ViewerProgress] = {}
        self._frame: dict[str, Any] = {}
        self._wanted: asyncio.Event | None = None

    def open(self, twin: Twin) -> None:
        """What there is to draw; from any thread."""
        self._twin = twin

    def look(self, looker: TwinViewer) -> None:
        """It wants frames from now on, everything first."""
        self._lookers[looker] = ViewerProgress()
        if self._wanted is not None:
            self._wanted.set()

    def leave(self, looker: TwinViewer) -> None:
        self._lookers.pop(looker, None)

    def drawn(self, looker: TwinViewer, number: int) -> None:
        """It says which frame it has drawn."""
        seen = self._lookers.get(looker)
        if seen is not None and 0 <= number <= seen.sent:
            seen.drawn = max(seen.drawn, number)

    async def run(self) -> None:
        """Send frames until cancelled."""
        self._wanted = asyncio.Event()
        while True:
            if not self._lookers:
                self._wanted.clear()
                await self._wanted.wait()
            try:
                self.turn()
            except Exception:  # one frame that cannot be made does not end the twin
                log.exception("a frame of the twin failed")
            await asyncio.sleep(1 / FRAMES_HZ)

    def turn(self) -> None:
        """Send each looker what changed since the frame before, where anything did."""
        ready = [(looker, seen) for looker, seen in self._lookers.items() if _ready(looker, seen)]
        if self._twin is None or not ready:
            return
        positions = self._plant.positions()
        before, self._frame = self._frame, self._twin.frame(positions, positions["now"])
        patch = changed(before, self._frame)
        text, everything = json.dumps(patch), ""
        for looker, seen in ready:
            if seen.whole:
                everything = everything or json.dumps(self._frame)
            elif not patch:
                continue
            seen.sent += 1
            looker.draw(seen.sent, everything if seen.whole else text)
            seen.whole = False


def _ready(looker: TwinViewer, seen: ViewerProgress) -> bool:
    """Whether it takes a frame; one that is away or behind is told everything later."""
    if looker.connected and seen.sent - seen.drawn <= BEHIND:
        return True
    seen.whole = True
    return False
