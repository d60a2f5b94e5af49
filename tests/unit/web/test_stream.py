"""The stream of changes, as each of its readers hears it."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Callable

import pytest
from tests.web_plant import TASK, VIEW, Plant

from arboleda.web import limits
from arboleda.web.stream import Changes, tell

KNOWN = {"id": "t-1", "text": "sis_a 0b 7", "cell": "sis_a", "reason": None, "sentence": ""}


def task(state: str) -> list[dict]:
    return [TASK | {"state": state}]


async def heard(stream: AsyncIterator[str]) -> tuple[str, str, dict]:
    """(id, kind, row) of the next event."""
    fields = dict(line.split(": ", 1) for line in (await anext(stream)).splitlines() if line)
    return fields["id"], fields["event"], json.loads(fields["data"])


async def reader(
    changes: Changes, last: str = "", alive: Callable[[], bool] = lambda: True
) -> AsyncIterator[str]:
    """The events one by one, which may leave together."""
    async for text in tell(changes, last, alive):
        for each in text.removesuffix("\n\n").split("\n\n"):
            yield f"{each}\n\n"


def test_it_begins_with_the_plant_and_goes_on_with_changes(plant: Plant) -> None:
    async def listen() -> None:
        stream = reader(Changes(plant))
        assert await heard(stream) == ("7-0", "snapshot", VIEW)
        plant.becomes(tasks=task("running"))
        plant.becomes(tasks=task("running"))
        plant.becomes(tasks=task("done"), ending=True)
        assert await heard(stream) == ("7-1", "task", KNOWN | {"state": "running"})
        assert await heard(stream) == ("7-2", "plant", {"plant": "demo", "epoch": 7, "ending": True})
        assert await heard(stream) == ("7-3", "task", KNOWN | {"state": "done"})

    asyncio.run(listen())


def test_two_readers_hear_the_same(plant: Plant) -> None:
    async def listen() -> None:
        changes = Changes(plant)
        one, other = reader(changes), reader(changes)
        assert await heard(one) == await heard(other)
        plant.becomes(tasks=task("failed"))
        assert await heard(one) == await heard(other)

    asyncio.run(listen())


def test_whoever_begins_with_the_plant_is_given_a_snapshot_that_is_made_once(plant: Plant) -> None:
    async def listen() -> None:
        changes = Changes(plant)
        one, other = tell(changes, "", lambda: True), tell(changes, "", lambda: True)
        assert await anext(one) is await anext(other)
        plant.becomes(tasks=task("running"))
        await anext(one)
        later = await heard(reader(changes))
        assert later[0] == "7-1" and later[2]["tasks"] == task("running")

    asyncio.run(listen())


def test_what_changed_in_one_moment_leaves_together(plant: Plant) -> None:
    async def listen() -> None:
        stream = tell(Changes(plant), "", lambda: True)
        await anext(stream)
        plant.becomes(tasks=task("done"), ending=True)
        assert (await anext(stream)).count("event: ") == 2

    asyncio.run(listen())


def test_whoever_comes_back_hears_what_it_missed(plant: Plant) -> None:
    async def listen() -> None:
        changes = Changes(plant)
        stream = reader(changes)
        await heard(stream)
        plant.becomes(tasks=task("running"))
        last, _, _ = await heard(stream)
        plant.becomes(tasks=task("done"))
        missed = await heard(stream)
        assert await heard(reader(changes, last)) == missed

    asyncio.run(listen())


@pytest.mark.parametrize("last", ["6-1", "7-9", "\u00e9", "0" * 500])
def test_whoever_was_away_too_long_gets_the_whole_plant(plant: Plant, last: str) -> None:
    async def listen() -> None:
        changes = Changes(plant)
        stream = reader(changes)
        await heard(stream)
        plant.becomes(tasks=task("running"))
        assert (await heard(stream))[0] == "7-1"
        assert (await heard(reader(changes, last)))[1] == "snapshot"

    asyncio.run(listen())


def test_silence_is_filled_with_comments(plant: Plant, monkeypatch: pytest.MonkeyPatch) -> None:
    async def listen() -> None:
        stream = reader(Changes(plant))
        await heard(stream)
        with monkeypatch.context() as soon:
            soon.setattr(limits, "BEAT_S", 0)
            assert await anext(stream) == ": still here\n\n"
        plant.becomes(tasks=task("running"))
        assert (await heard(stream))[0] == "7-1"

    asyncio.run(listen())


def test_a_stream_ends_with_its_session_and_leaves_its_place(plant: Plant) -> None:
    async def listen() -> list[str]:
        changes, sessions = Changes(plant), [True]
        stream = reader(changes, alive=lambda: bool(sessions))
        await heard(stream)
        assert len(changes) == 1
        sessions.clear()
        plant.becomes(tasks=task("running"))
        rest = [text async for text in stream]
        assert len(changes) == 0
        return rest

    assert asyncio.run(listen()) == []
