"""Pages that no browser has opened yet, and the end of what sends frames."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import pytest

from arboleda.dashboard import frames
from arboleda.dashboard.frames import ended
from arboleda.dashboard.shell import PageBudget


class Page:
    """A client of NiceGUI, as far as `PageBudget` knows it."""

    def __init__(self, id: str) -> None:
        self.id = id
        self.deleted = False
        self.opened: list[Callable[[], None]] = []
        self.on_connect = self.opened.append
        self._ends: list[Callable[[], None]] = []
        self.on_delete = self._ends.append

    def open(self) -> None:
        for each in self.opened:
            each()

    def delete(self) -> None:
        self.deleted = True
        for each in self._ends:
            each()


def pages(unopened: PageBudget, count: int) -> list[Page]:
    made = [Page(str(number)) for number in range(count)]
    for each in made:
        unopened.add(each)  # type: ignore[arg-type]
    return made


def test_the_oldest_that_nobody_opened_go() -> None:
    made = pages(PageBudget(most=3), 5)
    assert [page.deleted for page in made] == [True, True, False, False, False]


def test_a_page_that_was_opened_stays_whatever_comes_after_it() -> None:
    unopened = PageBudget(most=3)
    opened = Page("opened")
    unopened.add(opened)  # type: ignore[arg-type]
    opened.open()
    pages(unopened, 10)
    assert not opened.deleted


def test_one_that_was_deleted_otherwise_counts_no_more() -> None:
    unopened = PageBudget(most=3)
    gone = Page("gone")
    unopened.add(gone)  # type: ignore[arg-type]
    gone.delete()
    assert not any(page.deleted for page in pages(unopened, 3))


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
