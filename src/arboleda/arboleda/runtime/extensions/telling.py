"""Thread of a part of a package, in which it is told of the plant: a slow listener delays nobody else."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, NamedTuple, TypeVar

from arboleda.host.pieces import Piece, Pieces

from ..parts.listeners import named

Given = TypeVar("Given")
ENDS_S = 2.0  # what is left is told within that at the end


Tell = Callable[[Callable[[Any], object]], Callable[[Any], None]]
"""Has a function called later, in a thread of the part, as `Telling.each` does."""


class Answer(Future[Given]):
    """Answer that comes later; the thread of the part calls its callbacks."""

    def __init__(self, tell: Tell) -> None:
        super().__init__()
        self._tell = tell

    def add_done_callback(self, fn: Callable[[Future[Given]], object]) -> None:
        """Have a function called with this future once it is done."""
        super().add_done_callback(self._tell(fn))


class _News(NamedTuple):
    listener: Callable[[Any], object]
    piece: Piece
    told: Any


class Telling:
    """Telling of one package's listeners, one after the other, in a thread of its own.

    A listener that raises is left out, and nobody else. It begins with `start`; what comes before waits.
    """

    def __init__(self, name: str, pieces: Pieces, piece: Callable[[str], Piece]) -> None:
        self._pieces = pieces
        self._piece = piece
        self._news: deque[_News] = deque()
        self._latest: dict[Piece, _News] = {}
        self._changed = threading.Condition()
        self._ends = self._is_left = False
        self._thread = threading.Thread(target=self._run, name=f"extension {name}", daemon=True)

    def each(self, listener: Callable[[Any], object]) -> Callable[[Any], None]:
        """A function that has the listener told of everything, in order; it waits for nothing."""
        piece = self._piece(f"the listener {named(listener)}")
        return lambda told: self._put(_News(listener, piece, told))

    def latest(self, listener: Callable[[Any], object]) -> Callable[[Any], None]:
        """The same of a listener that is told only of the latest, where it is slower than what comes."""
        piece = self._piece(f"the listener {named(listener)}")
        return lambda told: self._put(_News(listener, piece, told), is_latest=True)

    def start(self) -> None:
        self._thread.start()

    def leave(self) -> None:
        """Tell nothing more, for good; from any thread."""
        with self._changed:
            self._is_left = True
            self._news.clear()
            self._latest.clear()

    def stop(self) -> None:
        """Tell what is left, and end; a listener that hangs is not waited for longer than ENDS_S."""
        with self._changed:
            self._ends = True
            self._changed.notify()
        if self._thread.ident is not None and self._thread is not threading.current_thread():
            self._thread.join(ENDS_S)

    def turn(self) -> bool:
        """Tell one thing that waits; False where nothing does. The thread does it, and tests may."""
        with self._changed:
            if self._news:
                news = self._news.popleft()
            elif self._latest:
                news = self._latest.pop(next(iter(self._latest)))
            else:
                return False
        if news.piece in self._pieces:
            with self._pieces.calling(news.piece):
                news.listener(news.told)
        return True

    def _put(self, news: _News, *, is_latest: bool = False) -> None:
        if news.piece not in self._pieces:
            return
        with self._changed:
            if self._is_left:
                return
            if is_latest:
                self._latest[news.piece] = news
            else:
                self._news.append(news)
            self._changed.notify()

    def _run(self) -> None:
        while self._waits():
            self.turn()

    def _waits(self) -> bool:
        """Wait for something to tell; False at the end."""
        with self._changed:
            self._changed.wait_for(lambda: self._news or self._latest or self._ends)
            return bool(self._news or self._latest)
