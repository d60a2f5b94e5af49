"""Show of the twin: has every browser that looks at it draw it, and does nothing while none does."""

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
    """The progress of one viewer: the number of frames sent to it, and of those that it has drawn."""

    def __init__(self) -> None:
        self.whole = True  # the next frame has everything
        self.sent = 0
        self.drawn = 0


class Show:
    """Show: `look` and `leave` for browsers, `run` in the server's event loop."""

    def __init__(self, plant: PageApi) -> None:
        self._plant = plant
        self._twin: Twin | None = None
        self._lookers: dict[TwinViewer, ViewerProgress] = {}
        self._frame: dict[str, Any] = {}
        self._wanted: asyncio.Event | None = None

    def open(self, twin: Twin) -> None:
        """Take the twin that is drawn from now on; from any thread."""
        self._twin = twin

    def look(self, looker: TwinViewer) -> None:
        """Send frames to this viewer from now on, everything first."""
        self._lookers[looker] = ViewerProgress()
        if self._wanted is not None:
            self._wanted.set()

    def leave(self, looker: TwinViewer) -> None:
        self._lookers.pop(looker, None)

    def drawn(self, looker: TwinViewer, number: int) -> None:
        """Note the frame that a viewer says it has drawn."""
        progress = self._lookers.get(looker)
        if progress is not None and 0 <= number <= progress.sent:
            progress.drawn = max(progress.drawn, number)

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
        """Send each viewer the difference to its last frame, if there is any."""
        ready = [(looker, progress) for looker, progress in self._lookers.items() if _ready(looker, progress)]
        if self._twin is None or not ready:
            return
        positions = self._plant.positions()
        before, self._frame = self._frame, self._twin.frame(positions, positions["now"])
        patch = changed(before, self._frame)
        text, everything = json.dumps(patch), ""
        for looker, progress in ready:
            if progress.whole:
                everything = everything or json.dumps(self._frame)
            elif not patch:
                continue
            progress.sent += 1
            looker.draw(progress.sent, everything if progress.whole else text)
            progress.whole = False


def _ready(looker: TwinViewer, progress: ViewerProgress) -> bool:
    """True if a viewer can take a frame; one that is away or behind gets everything later."""
    if looker.connected and progress.sent - progress.drawn <= BEHIND:
        return True
    progress.whole = True
    return False
