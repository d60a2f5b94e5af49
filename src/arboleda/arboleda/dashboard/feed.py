"""Feed of open pages from the plant's thread: the changes, FRAMES_HZ times a second, once per language."""

from __future__ import annotations

import asyncio
import logging
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from typing import Any

from arboleda.store.task_rows import TaskRow

from .faces import Face
from .faces.moment import Moment
from .frames import BEAT_S, Frames, Viewer
from .page_api import WAITING, PageApi, Seen
from .page_state import PageState, nothing_added

FRAMES_HZ = 10.0

log = logging.getLogger(__name__)


class Feed:
    """`add` and `remove` viewers, `run` in the server's event loop. The plant's thread only appends.

    `seen` gives what the plant did before it is listened to.
    """

    def __init__(
        self,
        plant: PageApi,
        added: Callable[[Moment], Face] = nothing_added,
        seen: Callable[[], Iterable[Seen]] = tuple,
    ) -> None:
        self._plant = plant
        self._added = added
        self._seen = seen
        self._snapshots: deque[Seen] = deque(maxlen=WAITING)
        self._story: PageState | None = None
        self._frames = Frames()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._news: asyncio.Event | None = None
        self._unwatch: Callable[[], None] | None = None

    @property
    def events(self) -> list[dict[str, Any]]:
        """The time line, the newest event last."""
        return list(self._story.chronicle.events) if self._story else []

    def task_face(self, id: str, language: str, kept: TaskRow | None) -> Face:
        """The page of one task, without its row; `kept` is its row in the history."""
        self._take_in()
        return self._story.task_face(id, language, kept) if self._story else {}

    def add(self, viewer: Viewer) -> None:
        """Add the viewer of a page that was opened or is back: it will get everything."""
        self._frames.add(viewer)
        self._wake()

    def remove(self, viewer: Viewer) -> None:
        self._frames.remove(viewer)

    def note_shown(self, viewer: Viewer, number: int) -> None:
        """Note the frame that a page says it has shown."""
        self._frames.note_shown(viewer, number)

    def start(self) -> None:
        """Listen to the plant; in the event loop that will `run`."""
        self._loop, self._news = asyncio.get_running_loop(), asyncio.Event()
        self.begin()

    def begin(self) -> None:
        """Listen to the plant; `turn` takes in its news."""
        self._story = PageState(self._plant.layout(), self._plant.past_acts(), self._added)
        self._snapshots.extend(self._seen())
        self._unwatch = self._plant.watch(self._tell)
        self._tell(self._plant.snapshot())

    async def run(self) -> None:
        """Send frames until cancelled."""
        assert self._news is not None
        while True:
            with suppress(asyncio.TimeoutError):
                await asyncio.wait_for(self._news.wait(), BEAT_S)
            quiet = not self._news.is_set()
            self._news.clear()
            try:
                if (
                    quiet and self._frames.languages
                ):  # one that does not answer raises, and no page gets a beat
                    self._snapshots.append((time.time(), self._plant.snapshot()))
                for _ in self._parts(time.monotonic()):
                    await asyncio.sleep(0)  # a stop may come between two parts
            except Exception:  # one frame that cannot be made does not end the page
                log.exception("a frame of the page failed")
            await asyncio.sleep(1 / FRAMES_HZ)

    def stop(self) -> None:
        if self._unwatch is not None:
            self._unwatch()
            self._unwatch = None

    def turn(self, now_s: float) -> None:
        """Take in the plant's news, and send each viewer what it lacks, or that nothing is new."""
        for _ in self._parts(now_s):
            pass

    def _parts(self, now_s: float) -> Iterator[None]:
        """The parts of a turn, each of some milliseconds where there are 100 cells."""
        story = self._story
        if story is None:
            return
        self._take_in()
        yield
        languages = self._frames.languages
        links = self._plant.links() if languages else {}
        for language in languages:
            face = story.face(language, links)
            yield
            if language in self._frames.languages:  # else its last viewer has left meanwhile
                self._frames.send(language, face, now_s)
            yield

    def _take_in(self) -> None:
        while self._snapshots and self._story is not None:
            unix_s, snapshot = self._snapshots.popleft()
            self._story.see(snapshot, unix_s)

    def _tell(self, snapshot: dict[str, Any]) -> None:
        self._snapshots.append((time.time(), snapshot))
        self._wake()

    def _wake(self) -> None:
        if self._loop is not None and self._news is not None:
            with suppress(RuntimeError):  # the loop has ended, and the page with it
                self._loop.call_soon_threadsafe(self._news.set)
