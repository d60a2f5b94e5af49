"""Checks of a plant's place in the file system or database, repeated in a thread of their own."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence

from arboleda.model.errors import ArboledaError

from .part import Crash

LOOK_S = 0.5  # what is found is said within a second
PATIENCE_S = 3.0  # a look may hang with its disk, and the end of the plant does not wait for that


class Periodic:
    """Periodic: ends the plant if a check raises ArboledaError; it calls `crash` once.

    The plant's own thread may hang in a commit, or have nothing to commit for hours.
    """

    def __init__(self, name: str, looks: Sequence[Callable[[], None]], crash: Crash) -> None:
        self._name = name
        self._looks = looks
        self._crash = crash
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        self._ending.set()
        if self._thread.ident is not None and self._thread is not threading.current_thread():
            self._thread.join(PATIENCE_S)

    def turn(self) -> None:
        """Make all checks once; the thread calls it, tests may."""
        try:
            for look in self._looks:
                look()
        except ArboledaError as error:
            self._ending.set()
            self._crash(self._name, error)

    def _run(self) -> None:
        while not self._ending.wait(LOOK_S):
            self.turn()
