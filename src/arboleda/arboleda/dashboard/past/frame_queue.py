"""Frames of records, one after the other."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import TypeVar

BESIDE_S = 0.2  # between two frames beside a plant that runs: all of Python takes turns with its steps

Made = TypeVar("Made")


class FrameQueue:
    """Has them made in a thread, of all pages one at a time, with `pause_s` after each."""

    def __init__(self, pause_s: float = 0.0) -> None:
        self._pause_s = pause_s
        self._free = asyncio.Lock()
        self._due = 0.0

    async def take(self, make: Callable[[], Made]) -> Made:
        """What `make` makes."""
        clock = asyncio.get_running_loop().time
        async with self._free:
            await asyncio.sleep(max(0.0, self._due - clock()))
            try:
                return await asyncio.to_thread(make)
            finally:
                self._due = clock() + self._pause_s
