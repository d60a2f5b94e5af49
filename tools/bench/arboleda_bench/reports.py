"""Reports of a driver, and the wait for one of them."""

from __future__ import annotations

import queue
import time
from collections.abc import Callable
from contextlib import suppress

from arboleda.drivers import Report
from arboleda.extension import ArboledaError


class Reports:
    """Reports: what a driver has told, in order; `patience_s` is the longest wait for the one that is due."""

    def __init__(self, patience_s: float) -> None:
        self._patience_s = patience_s
        self._reports: queue.Queue[Report] = queue.Queue()

    def hear(self, report: Report) -> None:
        self._reports.put(report)

    def until(self, fits: Callable[[Report], bool]) -> None:
        """Wait for a report that fits, however many others come; ArboledaError if none does in time."""
        latest = time.monotonic() + self._patience_s
        while (left_s := latest - time.monotonic()) > 0:
            with suppress(queue.Empty):
                if fits(self._reports.get(timeout=left_s)):
                    return
        raise ArboledaError(f"the driver did not report what was waited for within {self._patience_s:g} s")
