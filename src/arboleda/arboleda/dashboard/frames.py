"""Frames for open pages: to each what changed since the last one that it was sent."""

from __future__ import annotations

import asyncio
import json
import math
from collections.abc import Callable, Coroutine
from typing import Any, Protocol

from arboleda.views.changes import changed

from .faces import Face

AGAIN_S = 0.5
BEAT_S = 1.0  # a page that was sent nothing for so long is sent an empty frame: what it shows is still so
BEHIND = 30  # frames that a browser may not have seen yet; it gets no more before it has


class Viewer(Protocol):
    """One open page."""

    language: str

    @property
    def connected(self) -> bool: ...

    def show(self, number: int, patch: str) -> None:
        """Send one frame: its number among those that it was sent, and what changed as JSON."""


class ViewerProgress:
    """The progress of one viewer through the frames that it was sent."""

    def __init__(self) -> None:
        self.whole = True  # the next frame has everything
        self.sent = 0
        self.sent_s = -math.inf
        self.shown = 0


class Frames:
    """Frames: keeps the viewers and the last frame in each language, and sends each viewer the difference."""

    def __init__(self) -> None:
        self._viewers: dict[Viewer, ViewerProgress] = {}
        self._shown: dict[str, Face] = {}

    @property
    def languages(self) -> set[str]:
        """The languages in which somebody looks."""
        return {viewer.language for viewer in self._viewers}

    def add(self, viewer: Viewer) -> None:
        """Add the viewer of a page that was opened or is back: it will get everything."""
        self._viewers[viewer] = ViewerProgress()

    def remove(self, viewer: Viewer) -> None:
        self._viewers.pop(viewer, None)

    def note_shown(self, viewer: Viewer, number: int) -> None:
        """Note the frame that a page says it has shown."""
        known = self._viewers.get(viewer)
        if known is not None and 0 <= number <= known.sent:
            known.shown = max(known.shown, number)

    def send(self, language: str, face: Face, now_s: float) -> None:
        """Send each viewer of a language the changes since its last frame, and every BEAT_S even none."""
        self._shown = {each: self._shown.get(each, {}) for each in self.languages}
        patch = changed(self._shown[language], face)
        self._shown[language] = face
        text, everything = json.dumps(patch), ""
        for viewer, progress in self._viewers.items():
            if viewer.language != language or not self._ready(viewer, progress):
                continue
            if progress.whole:
                everything = everything or json.dumps(face)
            elif not patch and now_s - progress.sent_s < BEAT_S:
                continue
            progress.sent += 1
            progress.sent_s = now_s
            viewer.show(progress.sent, everything if progress.whole else text)
            progress.whole = False

    def _ready(self, viewer: Viewer, progress: ViewerProgress) -> bool:
        """True if a viewer can take a frame; one that is away or behind gets everything later."""
        if viewer.connected and progress.sent - progress.shown <= BEHIND:
            return True
        progress.whole = True
        return False


class Background:
    """Background: the coroutines of a page that run in the server's loop from `start` to `stop`."""

    def __init__(self, *works: Callable[[], Coroutine[Any, Any, None]]) -> None:
        self._works = works
        self._running: list[asyncio.Task[None]] = []

    def start(self) -> None:
        self._running += [asyncio.create_task(work()) for work in self._works]

    async def stop(self) -> None:
        """Cancel all of it and wait for its end."""
        await asyncio.gather(*map(ended, self._running))


async def ended(task: asyncio.Task[None]) -> None:
    """Cancel a task and wait for its end. Before Python 3.12 `asyncio.wait_for` may swallow a cancellation
    that comes just as what it waits for is there: then it is cancelled once more."""
    while not task.done():
        task.cancel()
        await asyncio.wait([task], timeout=AGAIN_S)
