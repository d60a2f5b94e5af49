"""Plants of a site behind real servers: each is looked at by itself, and all are told to stop."""

from __future__ import annotations

import asyncio
import socket
import time
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

import pytest
from fastapi import FastAPI
from fastapi.responses import JSONResponse
from tests.contract.web.conftest import running
from tests.patience import PATIENCE_S
from tests.web_plant import TOKENS, VIEW, Plant

from arboleda.model.messages import Verb
from arboleda.runtime.endpoints import Place
from arboleda.web.access.auth import Door, Role
from arboleda.web.access.guard import Guard
from arboleda.web.access.names import names_for
from arboleda.web.server import Server
from arboleda_fleet.oee.api import OeeApi
from arboleda_fleet.site.side import LastSeenPlant, RequestOutcome
from arboleda_fleet.site.watch import NOT_STOPPED, Site

T = TypeVar("T")


@contextmanager
def standby(plant: str) -> Iterator[str]:
    """The address of a process that waits to lead that plant."""
    app = FastAPI()

    @app.get("/api/plant")
    async def status() -> JSONResponse:
        return JSONResponse({"plant": plant, "standby": True, "sentence": "waits", "leader": ""})

    server = Server(Guard(app, names_for("127.0.0.1", None), Door(None)), port=0)
    try:
        yield f"http://127.0.0.1:{server.start()}"
    finally:
        server.stop()


@pytest.fixture(autouse=True)
def patience(monkeypatch: pytest.MonkeyPatch) -> None:
    """A plant answers whenever it comes to that."""
    monkeypatch.setattr("arboleda_fleet.site.reach.ANSWER_S", PATIENCE_S)


def called(name: str, seconds: float = 60.0) -> Plant:
    """A plant of that name that promises each task within so many seconds."""
    plant = Plant()
    plant.view = VIEW | {"plant": name}
    plant.seconds = seconds
    plant.offered[OeeApi] = plant
    return plant


def watched(places: list[Place], act: Callable[[Site], Awaitable[T]]) -> T:
    """The result of `act` with a site that watches these places."""

    async def run() -> T:
        site = Site(lambda: places)
        site.start()
        try:
            return await act(site)
        finally:
            await site.close()

    return asyncio.run(run())


async def until(enough: Callable[[], object]) -> None:
    ends = time.monotonic() + PATIENCE_S
    while not enough():
        assert time.monotonic() < ends
        await asyncio.sleep(0.05)


async def looked(site: Site, *names: str) -> list[LastSeenPlant]:
    """The plants once those of these names have been heard of."""
    await until(lambda: [plant.name for plant in site.plants() if plant.silent is None] == list(names))
    return site.plants()


def test_a_stop_of_all_reaches_every_plant_while_one_does_not_answer() -> None:
    first, second = called("first"), called("second")
    deaf = socket.create_server(("127.0.0.1", 0))
    silent = f"http://127.0.0.1:{deaf.getsockname()[1]}"

    async def stop(site: Site) -> RequestOutcome:
        await looked(site, "first", "second")
        answer = asyncio.create_task(site.stop())
        await until(lambda: first.acts and second.acts)
        assert not answer.done()
        deaf.close()  # until then it took connections and said nothing
        return await answer

    with deaf, running(first) as one, running(second) as two:
        answer = watched([Place(url=silent), Place(url=one.origin), Place(url=two.origin)], stop)
    assert first.acts == second.acts == [(Verb.STOP, "", False)]
    assert not answer.good and answer.sentence.phrase is NOT_STOPPED
    assert silent in str(answer.sentence) and "2 other plants heard the stop" in str(answer.sentence)


def test_a_task_is_given_to_the_plant_that_promises_to_be_first_with_the_reason() -> None:
    north, south = called("north", 50.0), called("south", 20.0)

    async def submit(site: Site) -> RequestOutcome:
        await looked(site, "north", "south")
        return await site.submit("", "north/sis_a,south/sis_b,south/sis_a 0b 7")

    with running(north) as one, running(south) as other:
        answer = watched([Place(url=one.origin), Place(url=other.origin)], submit)
    assert (north.texts, south.texts) == ([], ["sis_b 0B 7"])
    why = "south/sis_b is expected to have done it first, in 20 s; north/sis_a in 50 s, south/sis_a in 20 s"
    assert south.choices == [why]
    assert answer.good and str(answer.sentence) == f"south has taken sis_a 0b 7 (#t-1); {why}"


def test_a_leader_of_a_network_is_shown_its_token_and_is_one_plant_with_its_standby() -> None:
    async def look(site: Site) -> list[LastSeenPlant]:
        await until(lambda: [each.standbys for each in site.plants()] == [1])
        return site.plants()

    with standby("demo") as waits, running(called("demo"), TOKENS) as web:
        known = Place(url=web.origin, token=TOKENS[Role.OPERATOR])
        (plant,) = watched([Place(url=waits), known], look)
    assert (plant.name, plant.url, plant.silent) == ("demo", web.origin, None)
