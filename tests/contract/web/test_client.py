"""The client of the commands, against the real server."""

from __future__ import annotations

import json
import os

import pytest

from arboleda.cli.client import PlantClient
from arboleda.client import Conflict
from arboleda.model.errors import ArboledaError, QueueFull, TextError
from arboleda.model.messages import Verb
from arboleda.runtime import tokens
from arboleda.runtime.state import StateDir
from arboleda.web import stream

from .conftest import QUEUED, TASK, VIEW


@pytest.fixture
def state(port, tmp_path):
    with StateDir(tmp_path / "state") as made:
        made.announce(port)
        yield made


def test_the_client_submits_and_looks(state, plant, monkeypatch):
    monkeypatch.setenv("http_proxy", "http://127.0.0.1:9")
    client = PlantClient(state.path)
    assert client.submit("sis_a 0B 7") == QUEUED
    assert plant.asked_by == ["command"]
    assert client.status() == VIEW
    assert client.task("t-1") == QUEUED


@pytest.mark.parametrize("kind", [TextError, QueueFull, ArboledaError])
def test_the_client_says_what_the_plant_said(state, plant, kind):
    plant.answer = kind("No cell sis_x")
    with pytest.raises(ArboledaError, match=r"^No cell sis_x$") as said:
        PlantClient(state.path).submit("x")
    assert isinstance(said.value, kind)


def test_the_client_operates_the_plant_or_one_thing_of_it(state, plant):
    client = PlantClient(state.path)
    assert client.operate(Verb.STOP) == {"verb": "stop", "scope": ""}
    assert client.operate(Verb.HOME, "ra1", by_hand=True) == {"verb": "home", "scope": "ra1"}
    assert plant.acts == [(Verb.STOP, "", False), (Verb.HOME, "ra1", True)]
    plant.refusal = "ra1 still moves."
    with pytest.raises(Conflict, match=r"^ra1 still moves\.$"):
        client.operate(Verb.CLEAR, "sis_a")


def test_the_client_follows_an_act_until_it_has_ended(state, plant):
    rows = iter([{"outcome": "under_way"}, {"outcome": "under_way"}, {"outcome": "failed"}])
    plant.act = lambda number: {"number": number, **next(rows)}
    assert PlantClient(state.path).outcome(7) == {"number": 7, "outcome": "failed"}


def test_who_follows_a_task_listens_anew_where_its_stream_was_cut(state, monkeypatch):
    told = [
        VIEW,
        VIEW | {"tasks": [TASK | {"state": "running"}]},
        VIEW | {"tasks": [TASK | {"state": "done"}]},
    ]

    async def tell(*_):
        yield f"event: snapshot\ndata: {json.dumps(told.pop(0))}\n\n"

    monkeypatch.setattr(stream, "tell", tell)
    assert [now["state"] for now in PlantClient(state.path).follow(QUEUED)] == ["running", "done"]


def test_who_may_not_listen_is_told_why(port, tmp_path, serve):
    web = serve(streams=0)
    with StateDir(tmp_path / "full") as made:
        made.announce(web.port)
        with pytest.raises(ArboledaError, match="No more than 0 may listen at a time"):
            next(PlantClient(made.path).changes())


def test_without_a_plant_the_client_says_so(tmp_path):
    with pytest.raises(ArboledaError, match=f"No plant is running on {tmp_path}"):
        PlantClient(tmp_path).status()


def test_a_plant_without_its_api_is_said_to(tmp_path, free_port):
    with StateDir(tmp_path) as state:
        with pytest.raises(ArboledaError, match="still starting or ending"):
            PlantClient(tmp_path).status()
        state.announce(free_port)
        with pytest.raises(ArboledaError, match=f"process {os.getpid()}\\) did not answer"):
            PlantClient(tmp_path).status()


def test_a_guarded_plant_gets_the_operators_token_from_the_state_directory(tmp_path, serve, plant):
    known = tokens.read(tmp_path)
    web = serve(known)
    with StateDir(tmp_path) as made:
        made.announce(web.port, guarded=True)
        assert PlantClient(tmp_path).operate(Verb.RESET) == {"verb": "reset", "scope": ""}
        (tmp_path / tokens.TOKENS).unlink()
        with pytest.raises(ArboledaError, match="cannot be read"):
            PlantClient(tmp_path).status()


def test_an_answer_that_is_not_the_plants_is_said_to_be_none(state, plant):
    plant.view = {"plant": float("nan")}
    with pytest.raises(ArboledaError, match="internal error"):
        PlantClient(state.path).status()
