"""The end of what sends frames."""

from __future__ import annotations

import asyncio

import pytest

from arboleda.dashboard import frames
from arboleda.dashboard.frames import ended


def test_a_task_that_swallows_a_cancellation_ends_all_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(frames, "AGAIN_S", 0)

    async def run() -> bool:
        never, swallowed = asyncio.Event(), asyncio.Event()

        async def stubborn() -> None:
            try:
                await never.wait()
            except asyncio.CancelledError:
                swallowed.set()
            await never.wait()

        task = asyncio.create_task(stubborn())
        await asyncio.sleep(0)
        await ended(task)
        return swallowed.is_set() and task.cancelled()

    assert asyncio.run(run())
