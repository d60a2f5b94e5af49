"""`arboleda.client` against the real server: what it returns, what it raises, what it goes on after."""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.patience import PATIENCE_S
from tests.web_plant import QUEUED, TASK, VIEW, Plant

from arboleda.client import AsyncPlant, NoAnswer, NotFound, PlantError, WrongRequest
from arboleda.client import Plant as Client

from .conftest import Web, running

SOURCES = Path(__file__).parents[3] / "src/arboleda"
ELSEWHERE = (
    "rclpy",
    "paho",
    "nicegui",
    "fastapi",
    "starlette",
    "uvicorn",
    "pydantic",
    "py_trees",
    "yaml",
    "typer",
)
ALONE = """
import importlib.abc, sys

class Missing(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {missing!r}:
            raise ModuleNotFoundError(name)

sys.meta_path.insert(0, Missing())
from arboleda.client import Plant, NoAnswer
with Plant({url!r}) as plant:
    print(plant.submit("sis_a 0B 7").state, plant.snapshot().plant)
"""


@pytest.fixture
def client(local: Web) -> Iterator[Client]:
    with Client(local.origin, patience_s=0.0) as made:
        yield made


def test_it_works_where_nothing_of_a_plant_is_installed(local: Web) -> None:
    code = ALONE.format(missing=set(ELSEWHERE), url=local.origin)
    env = {**os.environ, "PYTHONPATH": str(SOURCES)}
    ran = subprocess.run([sys.executable, "-c", code], env=env, capture_output=True, text=True, check=False)
    assert (ran.stdout, ran.stderr) == ("queued demo\n", "")


def test_it_gives_tasks_and_looks(client: Client, plant: Plant, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("http_proxy", "http://127.0.0.1:9")
    task = client.submit("sis_a 0B 7 #lot42")
    assert (task.id, task.state, task.has_ended) == (QUEUED["id"], "queued", False)
    assert plant.texts == ["sis_a 0B 7 #lot42"] and plant.asked_by == ["http"]
    assert client.snapshot().tasks == client.tasks() and client.task("t-1").id == "t-1"
    assert client.stop().verb == "stop"


def test_nobody_and_nonsense_are_said_to_be_that(free_port: int) -> None:
    nobody, reason = f"http://127.0.0.1:{free_port}", f"cannot be reached at http://127.0.0.1:{free_port}"
    with Client(nobody, patience_s=0.0) as client, pytest.raises(NoAnswer, match=reason) as silent:
        client.snapshot()
    assert not silent.value.may_have_heard
    with Client("no address", patience_s=0.0) as client, pytest.raises(PlantError):
        client.snapshot()


def ended(state: str) -> dict[str, Any]:
    return TASK | {"state": state}


def test_events_and_tasks_go_on_after_a_restart_of_the_plant(free_port: int) -> None:
    before, after = Plant(), Plant()
    after.view = VIEW | {"epoch": 8}
    after.find = lambda id: ended("done")
    told: list[str] = []
    with Client(f"http://127.0.0.1:{free_port}", patience_s=PATIENCE_S) as client:
        waited = threading.Thread(target=lambda: told.append(client.wait("t-1").state))
        with running(before, port=free_port):
            events = client.events()
            assert next(events).row["epoch"] == 7
            waited.start()
        with running(after, port=free_port):
            assert next(events).row["epoch"] == 8
            waited.join(PATIENCE_S)
    assert told == ["done"]


def test_in_a_loop_of_asyncio_the_same_is_awaited(local: Web, plant: Plant) -> None:
    async def work() -> None:
        async with AsyncPlant(local.origin, patience_s=0.0) as client:
            assert (await client.submit("sis_a 0B 7")).state == "queued"
            assert [row.cell for row in await client.history()] == ["sis_b", "sis_a"]
            events = client.events()
            assert (await anext(events)).kind == "snapshot"
            plant.becomes(tasks=[ended("running")])
            assert (await anext(events)).row["state"] == "running"
            plant.find = lambda id: ended("done")
            assert (await client.wait("t-1")).has_ended
            with pytest.raises(NotFound):
                await client.act(7)
            with pytest.raises(WrongRequest):
                await client.operate("explode")

    asyncio.run(work())
