"""SIGHUP: the plant takes what its files have now, as after `arboleda apply`."""

from __future__ import annotations

import logging
import os
import signal
import threading
from collections.abc import Callable
from types import FrameType
from typing import Any

from arboleda.drivers import plain
from arboleda.extension import ArboledaError
from arboleda.host.signals import HANG_UP, has_terminal

LOG = logging.getLogger("arboleda.operators")
NAME = "SIGHUP"  # who puts it to work, in the journal
LONGEST = 500  # characters of a line


class HangUpPart:
    """Part that calls `put_files(NAME)` at each SIGHUP, in a thread of its own, and logs what comes of it.

    Whose terminal was closed gets the same signal: that ends the plant, as SIGTERM does. Only the main thread
    can take signals; a plant that another one starts takes none.
    """

    def __init__(self, put_files: Callable[[str], dict[str, Any]]) -> None:
        self._put_files = put_files
        self._before: Any = None
        self._had_terminal = False

    def start(self) -> None:
        if HANG_UP is not None and threading.current_thread() is threading.main_thread():
            self._had_terminal = has_terminal()
            self._before = signal.signal(HANG_UP, self._take)

    def stop(self) -> None:
        """Leave the signal to who had it before. Idempotent."""
        if self._before is None or HANG_UP is None:
            return
        if threading.current_thread() is threading.main_thread():
            signal.signal(HANG_UP, self._before)
            self._before = None

    def _take(self, number: int, frame: FrameType | None) -> None:
        if self._had_terminal and not has_terminal():
            os.kill(os.getpid(), signal.SIGTERM)
            return
        threading.Thread(target=self._put, name="sighup", daemon=True).start()

    def _put(self) -> None:
        try:
            answer = self._put_files(NAME)
        except ArboledaError as error:
            LOG.warning("nothing is put to work: %s", plain(str(error), LONGEST))
            return
        for line in answer["problems"]:
            LOG.warning("nothing is put to work: %s", plain(line, LONGEST))
        for line in answer["restart"]:
            LOG.warning("this needs a restart: %s", plain(line, LONGEST))
        for cell, when in answer["cells"].items():
            LOG.info("%s takes it %s", cell, when)
