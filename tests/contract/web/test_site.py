"""Plants of a site behind real servers: each is looked at by itself, and all are told to stop."""

from __future__ import annotations

import asyncio
import socket
import time
from collections.abc import Awaitable, Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from typing import TypeVar

import pytest
from fastapi import FastAPI
from fastapi.responses import JSONResponse

from arboleda.dashboard.frames import ended
from arboleda.dashboard.site.side import LastSeenPlant
from arboleda.model.messages import OperatorAnswer, Verb
from arboleda.runtime.endpoints import Place
from arboleda.site.reach import ANSWER_S, NO_ANSWER
from arboleda.site.watch import NOT_STOPPED, NOT_YET, STANDS_BY, STOPPED, STOPPED_ALL, Site
from arboleda.web.access.auth import Door, Role
from arboleda.web.access.guard import Guard
from arboleda.web.access.names import names_for
from arboleda.web.server import Server

from ...patience import PATIENCE_S, SOON_S
from .conftest import QUEUED, TOKENS, VIEW, Plant, running

T = TypeVar("T")


@contextmanager
def deaf() -> Iterator[str]:
    """An address that takes a connection and never answers."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        yield f"http://127.0.0.1:{listener.getsockname()[1]}"


@contextmanager
def standby(plant: str) -> Iterator[str]:
    """What answers while a process waits to lead that plant."""
    app = FastAPI()

    @app.get("/api/plant")
    async def status() -> JSONResponse:
        return JSONResponse({"plant": plant, "standby": True, "sentence": "waits", "leader": ""})

    @app.post("/{rest:path}")
    async def refuse(rest: str) -> JSONResponse:
        return JSONResponse({"sentence": "this process stands by"}, status_code=503)

    server = Server(Guard(app, names_for("127.0.0.1", None), Door(None)), port=0)
    try:
        yield f"http://127.0.0.1:{server.start()}"
    finally:
        server.stop()


@pytest.fixture(autouse=True)
def patience(monkeypatch: pytest.MonkeyPatch) -> None:
    """A plant answers whenever it comes to that; those that never do are waited for as a test says."""
    monkeypatch.setattr("arboleda.site.reach.ANSWER_S", PATIENCE_S)


def called(name: str) -> Plant:
    plant = Plant()
    plant.view = VIEW | {"plant": name}
    return plant


def watched(places: list[Place], act: Callable[[Site], Awaitable[T]]) -> T:
    """What `act` finds with a site that watches these places."""

    async def run() -> T:
        site = Site(lambda: places)
        site.start()
        try:
            return await act(site)
        finally:
            await site.close()

    return asyncio.run(run())


async def seen(site: Site, enough: Callable[[list[LastSeenPlant]], bool]) -> list[LastSeenPlant]:
    """The plants once they are as wanted."""
    ends = time.monotonic() + PATIENCE_S
    while not enough(site.plants()):
        assert time.monotonic() < ends, site.plants()
        await asyncio.sleep(0.05)
    return site.plants()


def heard(plants: list[LastSeenPlant]) -> list[str]:
    return [plant.name for plant in plants if plant.silent is None]


def test_a_plant_that_does_not_answer_holds_up_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("arboleda.site.reach.ANSWER_S", 2 * PATIENCE_S)  # longer than others are waited for
    with deaf() as silent, running(called("first")) as first, running(called("second")) as second:
        places = [Place(url=silent), Place(url=first.origin), Place(url=second.origin)]
        plants = watched(places, lambda site: seen(site, lambda plants: heard(plants) == ["first", "second"]))
    assert [each.silent for each in plants if each.url == silent] == [NOT_YET()]


def test_a_plant_that_does_not_answer_is_said_to_be_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("arboleda.site.reach.ANSWER_S", ANSWER_S)

    def looked_at(plants: list[LastSeenPlant]) -> bool:
        return len(plants) == 2 and NOT_YET() not in [each.silent for each in plants]

    with deaf() as silent, running(called("first")) as first:
        places = [Place(url=silent), Place(url=first.origin)]
        plants = watched(places, lambda site: seen(site, looked_at))
    assert [each.silent for each in plants if each.url == silent] == [NO_ANSWER(seconds=ANSWER_S)]


def test_a_stop_of_all_reaches_every_plant_and_names_those_that_did_not_hear_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("arboleda.site.reach.ANSWER_S", 10.0)
    first, second = called("first"), called("second")

    async def stop(site: Site) -> tuple[object, float]:
        await seen(site, lambda plants: heard(plants) == ["first", "second"])
        began = time.monotonic()
        answer = await site.stop()
        return answer, time.monotonic() - began

    with deaf() as silent, running(first) as one, running(second) as two:
        places = [Place(url=silent), Place(url=one.origin), Place(url=two.origin)]
        answer, took_s = watched(places, stop)
    assert first.acts == second.acts == [(Verb.STOP, "", False)]
    assert not answer.good and answer.sentence.phrase is NOT_STOPPED
    assert silent in str(answer.sentence) and "2 other plants heard the stop" in str(answer.sentence)
    assert ANSWER_S < 3.0, "a browser gives a stop up after 3 s"
    assert took_s < SOON_S


def test_a_stop_of_one_reaches_that_one() -> None:
    first, second = called("first"), called("second")

    async def stop(site: Site) -> object:
        await seen(site, lambda plants: heard(plants) == ["first", "second"])
        return await site.stop("second")

    with running(first) as one, running(second) as two:
        answer = watched([Place(url=one.origin), Place(url=two.origin)], stop)
    assert answer.good and (first.acts, second.acts) == ([], [(Verb.STOP, "", False)])


def test_where_there_is_no_plant_or_no_such_one_it_says_so() -> None:
    async def ask(site: Site) -> list[str]:
        answers = [await site.stop(), await site.stop("west"), await site.submit("", "sis_a 0b 7")]
        assert not any(each.good for each in answers)
        return [str(each.sentence) for each in answers]

    assert watched([], ask) == [
        "no plant is on this page",
        "there is no plant west on this page",
        "write plant/cell,plant/cell and the task, e.g. north/sis_a,south/sis_a 0B 7",
    ]


def test_the_same_stop_that_comes_by_two_ways_is_said_once() -> None:
    plant = called("first")
    plant.unanswered = []

    async def stop(site: Site) -> tuple[object, ...]:
        await seen(site, lambda plants: heard(plants) == ["first"])
        both = asyncio.gather(site.stop(), site.stop())
        while not plant.unanswered:
            await asyncio.sleep(0.01)
        future: Future[object] = plant.unanswered[0]
        future.set_result(OperatorAnswer(verb=Verb.STOP, scope=""))
        return tuple(await both)

    with running(plant) as web:
        answers = watched([Place(url=web.origin)], stop)
    assert len(plant.acts) == 1
    assert {each.sentence.phrase for each in answers} == {STOPPED}


def test_a_task_goes_to_its_plant_and_a_refusal_is_told() -> None:
    first, second = called("first"), called("second")

    async def submit(site: Site) -> tuple[object, object]:
        await seen(site, lambda plants: heard(plants) == ["first", "second"])
        taken = await site.submit("second", "sis_a 0b 7")
        second.answer = QUEUED | {"state": "refused", "sentence": "no such cell"}
        return taken, await site.submit("second", "sis_z 0b 7")

    with running(first) as one, running(second) as two:
        taken, refused = watched([Place(url=one.origin), Place(url=two.origin)], submit)
    assert (first.texts, second.texts) == ([], ["sis_a 0b 7", "sis_z 0b 7"])
    assert taken.good and str(taken.sentence) == "second has taken sis_a 0b 7 (#t-1)"
    assert not refused.good and str(refused.sentence) == "second: no such cell"


def test_a_leader_and_its_standby_are_one_plant() -> None:
    async def look(site: Site) -> list[LastSeenPlant]:
        return await seen(site, lambda plants: [each.standbys for each in plants] == [1])

    with standby("demo") as waits, running(called("demo")) as web:
        (plant,) = watched([Place(url=waits), Place(url=web.origin)], look)
    assert (plant.name, plant.url, plant.silent) == ("demo", web.origin, None)


def test_a_plant_of_which_only_the_standby_answers_does_not_look_well() -> None:
    async def look(site: Site) -> list[LastSeenPlant]:
        return await seen(site, lambda plants: plants and plants[0].silent == STANDS_BY())

    with standby("demo") as waits:
        (plant,) = watched([Place(url=waits)], look)
    assert plant.snapshot is None


def test_two_that_both_lead_a_plant_of_one_name_are_two_rows_and_both_are_stopped() -> None:
    first, second = called("demo"), called("demo")

    async def stop(site: Site) -> object:
        await seen(site, lambda plants: len(heard(plants)) == 2)
        return await site.stop()

    with running(first) as one, running(second) as two:
        answer = watched([Place(url=one.origin), Place(url=two.origin)], stop)
    assert answer.good and first.acts == second.acts == [(Verb.STOP, "", False)]
    assert answer.sentence == STOPPED_ALL(count=2)


@pytest.mark.parametrize("token", [TOKENS[Role.OPERATOR], ""])
def test_a_plant_of_a_network_is_shown_its_token(token: str) -> None:
    async def look(site: Site) -> list[LastSeenPlant]:
        return await seen(site, lambda plants: plants and plants[0].silent != NOT_YET())

    with running(called("demo"), TOKENS) as web:
        (plant,) = watched([Place(url=web.origin, token=token)], look)
    if token:
        assert plant.silent is None
    else:
        assert "wants a token" in str(plant.silent)


def test_a_task_that_swallows_a_cancellation_ends_all_the_same() -> None:
    async def run() -> bool:
        swallowed = asyncio.Event()

        async def stubborn() -> None:
            try:
                await asyncio.sleep(PATIENCE_S)
            except asyncio.CancelledError:
                swallowed.set()
            await asyncio.sleep(PATIENCE_S)

        task = asyncio.create_task(stubborn())
        await asyncio.sleep(0)
        await ended(task)
        return swallowed.is_set() and task.cancelled()

    assert asyncio.run(run())
