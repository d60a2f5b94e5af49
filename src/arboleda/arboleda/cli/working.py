"""A line on a terminal that says that a command is at work, once it has been for a while."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from arboleda.host.timer import called_after

AFTER_S = 0.3  # what is over sooner is felt to be at once
COMMAND = "arboleda"
CLEARED = "\r\x1b[K"
Show = Callable[[str], None]


class _Line:
    """Last line of standard error; nothing of it is left once it is cleared."""

    def __init__(self) -> None:
        self._words = ""
        self._shown = False

    def show(self) -> None:
        self._shown = True
        self._write(f"{CLEARED}{COMMAND} {self._words}...")

    def say(self, words: str) -> None:
        """Say how far it is, from when on the line is shown."""
        self._words = f"{words} "
        if self._shown:
            self.show()

    def clear(self) -> None:
        if self._shown:
            self._write(CLEARED)

    def _write(self, text: str) -> None:
        with suppress(OSError, ValueError):  # the terminal is gone: nobody looks
            os.write(sys.stderr.fileno(), text.encode())  # by a signal, in the middle of anything


_line: _Line | None = None


@contextmanager
def working() -> Iterator[Show]:
    """Time in which a command prints nothing; what is given says how far it is. One within another has its
    line.
    """
    global _line
    if _line is not None or sys.stderr is None or not sys.stderr.isatty():
        yield _line.say if _line is not None else _unsaid
        return
    line = _line = _Line()
    try:
        with called_after(AFTER_S, line.show):
            yield line.say
    finally:
        line.clear()
        _line = None


def _unsaid(_: str) -> None:
    pass
