"""The client of the commands, against the API of a plant in this process."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from fastapi import FastAPI
from tests.guarded_plant import guarded
from tests.in_process import Machine
from tests.in_process import machine as machine
from tests.web_plant import QUEUED, TASK, VIEW, Plant
from tests.web_plant import plant as plant

from arboleda.cli.client import PlantClient
from arboleda.client import Conflict
from arboleda.model.errors import ArboledaError, QueueFull, TextError
from arboleda.model.messages import Verb
from arboleda.runtime import tokens
from arboleda.runtime.state import StateDir
from arboleda.web import stream
from arboleda.web.api import answer_in_sentences


@pytest.fixture
def state(machine: Machine, plant: Plant, tmp_path: Path) -> Iterator[StateDir]:
    machine.listen(8080, guarded(plant).app)
    with StateDir(tmp_path / "state") as made:
        made.announce(8080)
        yield made


@pytest.mark.parametrize("kind", [TextError, QueueFull, ArboledaError])
def test_the_client_says_what_the_plant_said(state: StateDir, plant: Plant, kind: type) -> None:
    plant.answer = kind("No cell sis_x")
    with pytest.raises(ArboledaError, match=r"^No cell sis_x$") as said:
        PlantClient(state.path).submit("x")
    assert isinstance(said.value, kind)


def test_the_client_operates_the_plant_or_one_thing_of_it(state: StateDir, plant: Plant) -> None:
    client = PlantClient(state.path)
    assert client.operate(Verb.STOP) == {"verb": "stop", "scope": ""}
    assert client.operate(Verb.HOME, "ra1", by_hand=True) == {"verb": "home", "scope": "ra1"}
    assert plant.acts == [(Verb.STOP, "", False), (Verb.HOME, "ra1", True)]
    plant.refusal = "ra1 still moves."
    with pytest.raises(Conflict, match=r"^ra1 still moves\.$"):
        client.operate(Verb.CLEAR, "sis_a")


def test_the_client_asks_any_route(state: StateDir, plant: Plant) -> None:
    client = PlantClient(state.path)
    assert [row["id"] for row in client.get("/api/tasks")] == ["t-1"]
    assert client.post("/api/tasks", {"text": "sis_a 0B 7"})["state"] == "queued"
    with pytest.raises(ArboledaError, match="/api/docs"):
        client.post("/api/nothing", is_repeatable=True)


def test_the_client_follows_an_act_until_it_has_ended(state: StateDir, plant: Plant) -> None:
    rows = iter([{"outcome": "under_way"}, {"outcome": "under_way"}, {"outcome": "failed"}])
    plant.act = lambda number: {"number": number, **next(rows)}
    assert PlantClient(state.path).outcome(7) == {"number": 7, "outcome": "failed"}


def test_who_follows_a_task_listens_anew_where_its_stream_was_cut(
    state: StateDir, monkeypatch: pytest.MonkeyPatch
) -> None:
    told = [VIEW, *(VIEW | {"tasks": [TASK | {"state": each}]} for each in ("running", "done"))]

    async def tell(*_: object):
        yield f"event: snapshot\ndata: {json.dumps(told.pop(0))}\n\n"

    monkeypatch.setattr(stream, "tell", tell)
    assert [now["state"] for now in PlantClient(state.path).follow(QUEUED)] == ["running", "done"]


def test_who_may_not_listen_is_told_why(state: StateDir, machine: Machine, plant: Plant) -> None:
    full = FastAPI()
    answer_in_sentences(full)
    full.include_router(stream.routes(plant, 0))
    full.add_api_route("/api/plant", lambda: VIEW)
    machine.listen(8080, guarded(plant, behind=full).app)
    with pytest.raises(ArboledaError, match="No more than 0 may listen at a time"):
        next(PlantClient(state.path).changes())


def test_without_a_plant_the_client_says_so(tmp_path: Path) -> None:
    with pytest.raises(ArboledaError, match=f"No plant is running on {tmp_path}"):
        PlantClient(tmp_path).status()


@pytest.mark.usefixtures("machine")
def test_a_plant_without_its_api_is_said_to(tmp_path: Path) -> None:
    with StateDir(tmp_path) as state:
        with pytest.raises(ArboledaError, match="still starting or ending"):
            PlantClient(tmp_path).status()
        state.announce(8080)
        with pytest.raises(ArboledaError, match=f"process {os.getpid()}\\) did not answer"):
            PlantClient(tmp_path).status()


def test_a_guarded_plant_gets_the_operators_token_from_the_state_directory(
    machine: Machine, plant: Plant, tmp_path: Path
) -> None:
    machine.listen(8080, guarded(plant, tokens.read(tmp_path)).app)
    with StateDir(tmp_path) as made:
        made.announce(8080, guarded=True)
        assert PlantClient(tmp_path).operate(Verb.RESET) == {"verb": "reset", "scope": ""}
        (tmp_path / tokens.TOKENS).unlink()
        with pytest.raises(ArboledaError, match="cannot be read"):
            PlantClient(tmp_path).status()


def test_an_answer_that_is_not_the_plants_is_said_to_be_none(state: StateDir, plant: Plant) -> None:
    plant.view = {"plant": float("nan")}
    with pytest.raises(ArboledaError, match="internal error"):
        PlantClient(state.path).status()
