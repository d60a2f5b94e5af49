"""Plants of a site: each is looked at by itself, and all are told to stop."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Callable
from typing import Any, TypeVar

import httpx
import pytest
from starlette.types import Message, Receive, Scope, Send
from tests.in_process import Machine, without_threads
from tests.web_plant import QUEUED, VIEW

from arboleda.dashboard import frames
from arboleda.runtime.endpoints import Place
from arboleda_fleet.site import watch
from arboleda_fleet.site.reach import ANSWER_S, NO_ANSWER
from arboleda_fleet.site.side import LastSeenPlant
from arboleda_fleet.site.watch import NOT_STOPPED, NOT_YET, STANDS_BY, STOPPED, STOPPED_ALL, Site

T = TypeVar("T")
NEVER_S = 3600.0
TURNS = 2000  # of the event loop, in which everything that answers has answered
STOP = ("POST", "/api/plant/stop")


class Answering:
    """A plant of that name, or a process that stands by for it; notes what it is told to do."""

    def __init__(self, plant: str, *, standby: bool = False) -> None:
        led = {"plant": plant, "standby": True, "sentence": "waits", "leader": ""}
        self.answers: dict[tuple[str, str], tuple[int, Any]] = {
            ("GET", "/api/plant"): (200, led if standby else VIEW | {"plant": plant}),
            ("GET", "/api/oee"): (200, []),
            STOP: (503, {"sentence": "this process stands by"}) if standby else (200, {"verb": "stop"}),
            ("POST", "/api/tasks"): (202, QUEUED),
        }
        self.told: list[tuple[str, Any]] = []
        self.answers_now = asyncio.Event()
        self.answers_now.set()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["method"] == "POST":
            self.told.append((scope["path"], json.loads((await receive())["body"] or b"null")))
        await self.answers_now.wait()
        status, body = self.answers[scope["method"], scope["path"]]
        start: Message = {"type": "http.response.start", "status": status, "headers": []}
        await send(start)
        await send({"type": "http.response.body", "body": json.dumps(body).encode()})


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch) -> Machine:
    without_threads(monkeypatch)
    monkeypatch.setattr(watch, "LOOK_S", 0)
    monkeypatch.setattr(frames, "AGAIN_S", 0)
    return Machine(monkeypatch)


def watched(machine: Machine, act: Callable[[Site], Awaitable[T]], *those: Any) -> T:
    """The result of `act` with a site that watches these at the ports from 8080 on: all at once, and once."""
    for port, each in enumerate(those, 8080):
        machine.listen(port, each)
    places = [Place(url=url(number)) for number in range(len(those))]

    def find() -> list[Place]:
        asyncio.get_running_loop().call_soon(setattr, watch, "LOOK_S", NEVER_S)
        return places

    async def run() -> T:
        site = Site(find)
        site.start()
        try:
            return await act(site)
        finally:
            await site.close()

    return asyncio.run(run())


def url(number: int) -> str:
    return f"http://127.0.0.1:{8080 + number}"


async def seen(site: Site, enough: Callable[[list[LastSeenPlant]], Any]) -> list[LastSeenPlant]:
    """The plants once they are as wanted."""
    for _ in range(TURNS):
        if enough(site.plants()):
            return site.plants()
        await asyncio.sleep(0)
    raise AssertionError(site.plants())


def looked(*names: str) -> Callable[[Site], Awaitable[list[LastSeenPlant]]]:
    """The plants once those of these names have been heard of."""

    def heard(plants: list[LastSeenPlant]) -> bool:
        return [plant.name for plant in plants if plant.silent is None] == list(names)

    return lambda site: seen(site, heard)


def test_a_plant_that_does_not_answer_holds_up_no_other(machine: Machine) -> None:
    hanging = Answering("hanging")
    hanging.answers_now.clear()
    plants = watched(machine, looked("first", "second"), hanging, Answering("first"), Answering("second"))
    assert [each.silent for each in plants if each.url == url(0)] == [NOT_YET()]


def test_a_plant_that_did_not_answer_in_time_is_said_to_be_silent(machine: Machine) -> None:
    def asked(site: Site) -> Awaitable[list[LastSeenPlant]]:
        return seen(site, lambda plants: plants and plants[0].silent != NOT_YET())

    plants = watched(machine, asked, httpx.ReadTimeout("nothing came"))
    assert [each.silent for each in plants] == [NO_ANSWER(seconds=ANSWER_S)]
    assert ANSWER_S < 3.0, "a browser gives a stop up after 3 s"


def test_a_plant_that_wants_a_token_is_said_to_want_one(machine: Machine) -> None:
    guarded = Answering("demo")
    guarded.answers["GET", "/api/plant"] = (401, {"sentence": "This plant wants a token."})

    def asked(site: Site) -> Awaitable[list[LastSeenPlant]]:
        return seen(site, lambda plants: plants and plants[0].silent != NOT_YET())

    (plant,) = watched(machine, asked, guarded)
    assert "wants a token" in str(plant.silent) and plant.snapshot is None


def test_a_stop_of_all_reaches_every_plant_and_names_those_that_did_not_hear_it(machine: Machine) -> None:
    first, second = Answering("first"), Answering("second")

    async def stop(site: Site) -> Any:
        await looked("first", "second")(site)
        return await site.stop()

    answer = watched(machine, stop, httpx.ReadTimeout("nothing came"), first, second)
    assert first.told == second.told == [("/api/plant/stop", None)]
    assert not answer.good and answer.sentence.phrase is NOT_STOPPED
    assert url(0) in str(answer.sentence) and "2 other plants heard the stop" in str(answer.sentence)


def test_a_stop_is_sent_again_where_an_idle_connection_was_closed(machine: Machine) -> None:
    plant = Answering("first")

    async def stop(site: Site) -> Any:
        await looked("first")(site)
        machine.listen(8080, httpx.ReadError("closed"), plant)
        return await site.stop()

    answer = watched(machine, stop, plant)
    assert answer.good and plant.told == [("/api/plant/stop", None)]


def test_a_stop_of_one_reaches_that_one(machine: Machine) -> None:
    first, second = Answering("first"), Answering("second")

    async def stop(site: Site) -> Any:
        await looked("first", "second")(site)
        return await site.stop("second")

    assert watched(machine, stop, first, second).good
    assert (first.told, second.told) == ([], [("/api/plant/stop", None)])


def test_where_there_is_no_plant_or_no_such_one_it_says_so(machine: Machine) -> None:
    async def ask(site: Site) -> list[str]:
        answers = [await site.stop(), await site.stop("west"), await site.submit("", "sis_a 0b 7")]
        assert not any(each.good for each in answers)
        return [str(each.sentence) for each in answers]

    assert watched(machine, ask) == [
        "no plant is on this page",
        "there is no plant west on this page",
        "write plant/cell,plant/cell and the task, e.g. north/sis_a,south/sis_a 0B 7",
    ]


def test_the_same_stop_that_comes_by_two_ways_is_said_once(machine: Machine) -> None:
    plant = Answering("first")

    async def stop(site: Site) -> tuple[Any, ...]:
        await looked("first")(site)
        plant.answers_now.clear()
        both = asyncio.gather(site.stop(), site.stop())
        await seen(site, lambda _: plant.told)
        plant.answers_now.set()
        return tuple(await both)

    answers = watched(machine, stop, plant)
    assert plant.told == [("/api/plant/stop", None)]
    assert {each.sentence.phrase for each in answers} == {STOPPED}


def test_a_task_goes_to_its_plant_and_a_refusal_is_told(machine: Machine) -> None:
    first, second = Answering("first"), Answering("second")

    async def submit(site: Site) -> tuple[Any, Any]:
        await looked("first", "second")(site)
        taken = await site.submit("second", "sis_a 0b 7")
        second.answers["POST", "/api/tasks"] = (422, {"sentence": "no such cell"})
        return taken, await site.submit("second", "sis_z 0b 7")

    taken, refused = watched(machine, submit, first, second)
    assert first.told == []
    assert second.told == [("/api/tasks", {"text": text}) for text in ("sis_a 0b 7", "sis_z 0b 7")]
    assert taken.good and str(taken.sentence) == "second has taken sis_a 0b 7 (#t-1)"
    assert not refused.good and str(refused.sentence) == "second: no such cell"


def test_a_leader_and_its_standby_are_one_plant(machine: Machine) -> None:
    def both(site: Site) -> Awaitable[list[LastSeenPlant]]:
        return seen(site, lambda plants: [each.standbys for each in plants] == [1])

    (plant,) = watched(machine, both, Answering("demo", standby=True), Answering("demo"))
    assert (plant.name, plant.url, plant.silent) == ("demo", url(1), None)


def test_a_plant_of_which_only_the_standby_answers_does_not_look_well(machine: Machine) -> None:
    def standby(site: Site) -> Awaitable[list[LastSeenPlant]]:
        return seen(site, lambda plants: plants and plants[0].silent == STANDS_BY())

    (plant,) = watched(machine, standby, Answering("demo", standby=True))
    assert plant.snapshot is None


def test_two_that_both_lead_a_plant_of_one_name_are_two_rows_and_both_are_stopped(machine: Machine) -> None:
    first, second = Answering("demo"), Answering("demo")

    async def stop(site: Site) -> Any:
        await seen(site, lambda plants: len([each for each in plants if each.silent is None]) == 2)
        return await site.stop()

    answer = watched(machine, stop, first, second)
    assert answer.good and answer.sentence == STOPPED_ALL(count=2)
    assert first.told == second.told == [("/api/plant/stop", None)]
