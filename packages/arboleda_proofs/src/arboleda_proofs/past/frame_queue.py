"""Turns of pages at drawing frames of records, one after the other."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import TypeVar

BESIDE_S = 0.2  # between two frames beside a running plant, whose steps need Python's lock, too

Made = TypeVar("Made")


class FrameQueue:
    """FrameQueue: runs one function at a time in a thread, for all pages, with `pause_s` after each."""

    def __init__(self, pause_s: float = 0.0) -> None:
        self._pause_s = pause_s
        self._free = asyncio.Lock()
        self._due = 0.0

    async def take(self, make: Callable[[], Made]) -> Made:
        """Run `make` in a thread when its turn has come, and return its result."""
        clock = asyncio.get_running_loop().time
        async with self._free:
            await asyncio.sleep(max(0.0, self._due - clock()))
            try:
                return await asyncio.to_thread(make)
            finally:
                self._due = clock() + self._pause_s
