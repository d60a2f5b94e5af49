"""The page of a plant that is made late: when it is made, who waits for it, and what it has not missed."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable, Iterable
from contextlib import asynccontextmanager
from typing import Any, TypeVar

import httpx
import pytest
from fastapi import FastAPI
from tests.in_process import ORIGIN, without_threads

from arboleda.dashboard import late_page, page
from arboleda.dashboard.late_page import LatePage
from arboleda.model.errors import StartError
from arboleda.web.api import answer_in_sentences

Snapshot = dict[str, Any]
Ask = Callable[[], Awaitable[httpx.Response]]
Done = TypeVar("Done")


class Plant:
    """A plant of two robots that tells its snapshots to whoever watches."""

    def __init__(self) -> None:
        self.watchers: list[Callable[[Snapshot], None]] = []

    def watch(self, callback: Callable[[Snapshot], None]) -> Callable[[], None]:
        self.watchers.append(callback)
        return lambda: self.watchers.remove(callback)

    def tell(self, *, online: bool) -> None:
        for watcher in self.watchers:
            watcher({"robots": [{"online": True}, {"online": online}]})


class Late:
    """A server with a late page, which answers with the number of snapshots that it was given."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.plant, self.app, self.notes = Plant(), FastAPI(), list[str]()
        self.error: Exception | None = None
        answer_in_sentences(self.app)
        without_threads(monkeypatch)
        monkeypatch.setattr(page, "mount", self._mount)
        plant: Any = self.plant
        LatePage(plant, None, lambda: self.notes.append("made")).mount(self.app)

    def _mount(
        self, app: FastAPI, _plant: object, _leave_out: object, seen: Callable[[], Iterable[object]]
    ) -> None:
        if self.error is not None:
            raise self.error

        @app.get("/")
        async def shown() -> int:
            return given

        given = len([*seen()])
        app.router.lifespan_context = self._life

    @asynccontextmanager
    async def _life(self, _app: FastAPI) -> AsyncIterator[None]:
        self.notes.append("begun")
        yield
        self.notes.append("ended")

    def during(self, work: Callable[[Ask], Awaitable[Done]]) -> Done:
        """Do `work` while the server runs; it may ask for the page."""

        async def lives() -> Done:
            transport = httpx.ASGITransport(self.app)
            async with (
                self.app.router.lifespan_context(self.app),
                httpx.AsyncClient(transport=transport, base_url=ORIGIN) as browser,
            ):
                return await work(lambda: browser.get("/"))

        return asyncio.run(lives())


@pytest.fixture
def late(monkeypatch: pytest.MonkeyPatch) -> Late:
    return Late(monkeypatch)


async def _turns(_ask: Ask) -> None:
    for _ in range(20):
        await asyncio.sleep(0)


def test_it_is_not_made_before_every_robot_is_heard(late: Late) -> None:
    late.plant.tell(online=False)
    late.during(_turns)
    assert late.notes == []


def test_it_is_made_once_every_robot_is_heard_and_ends_with_the_server(late: Late) -> None:
    late.plant.tell(online=True)
    late.during(_turns)
    assert late.notes == ["made", "begun", "ended"]
    assert late.plant.watchers == []


def test_a_request_has_it_made_and_waits_for_it(late: Late) -> None:
    late.plant.tell(online=False)

    async def asked(ask: Ask) -> list[Any]:
        answers = await asyncio.gather(ask(), ask())
        return [answer.json() for answer in answers]

    assert late.during(asked) == [1, 1], "what the plant did before is given to it, and it is made once"
    assert late.notes == ["made", "begun", "ended"]


def test_it_is_made_in_time_though_a_robot_is_silent(late: Late, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(late_page, "LATEST_S", 0.0)
    late.plant.tell(online=False)
    late.during(_turns)
    assert late.notes == ["made", "begun", "ended"]


def test_a_page_that_cannot_be_made_says_why(late: Late, caplog: pytest.LogCaptureFixture) -> None:
    late.error = StartError("This process shows another page.")

    async def asked(ask: Ask) -> list[httpx.Response]:
        return [await ask(), await ask()]

    answers = late.during(asked)
    assert [answer.status_code for answer in answers] == [503, 503]
    assert answers[1].json() == {"sentence": "This process shows another page."}
    assert "the page cannot be shown" in caplog.text
