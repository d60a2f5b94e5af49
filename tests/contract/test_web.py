"""The HTTP API over real sockets, and the client of `submit` and `status`."""

from __future__ import annotations

import http.client
import json
import os
import threading
from concurrent.futures import Future

import httpx
import pytest

from arboleda.adapters.web import Api
from arboleda.app.client import PlantClient
from arboleda.app.state import StateDir
from arboleda.core.errors import ArboledaError, QueueFull, StartError, TextError

QUEUED = {"id": "t-1", "text": "sis_a 0b 7", "cell": "sis_a", "state": "queued", "sentence": ""}
VIEW = {"plant": "demo", "tasks": [QUEUED]}


class Plant:
    """Answers each text with what was prepared for it."""

    def __init__(self) -> None:
        self.texts: list[str] = []
        self.answer: dict | Exception | None = QUEUED
        self.view: dict | Exception = VIEW

    def look(self) -> dict:
        if isinstance(self.view, Exception):
            raise self.view
        return self.view

    def find(self, task: str) -> dict | None:
        return QUEUED if task == QUEUED["id"] else None

    def submit(self, text: str) -> Future:
        self.texts.append(text)
        future: Future = Future()
        if isinstance(self.answer, Exception):
            future.set_exception(self.answer)
        elif self.answer is not None:
            future.set_result(self.answer)
        return future


@pytest.fixture
def plant():
    return Plant()


@pytest.fixture
def port(plant):
    api = Api(plant.look, plant.find, plant.submit)
    yield api.start()
    api.stop()
    assert "http api" not in {thread.name for thread in threading.enumerate()}


@pytest.fixture
def web(port):
    with httpx.Client(base_url=f"http://127.0.0.1:{port}", trust_env=False) as client:
        yield client


def test_the_view_is_the_plant(web):
    answer = web.get("/api/plant")
    assert (answer.status_code, answer.json()) == (200, VIEW)


def test_a_good_text_is_queued(web, plant):
    answer = web.post("/api/tasks", json={"text": "sis_a 0B 7"})
    assert (answer.status_code, answer.json()) == (202, QUEUED)
    assert plant.texts == ["sis_a 0B 7"]


@pytest.mark.parametrize(
    ("said", "status"),
    [
        (QUEUED | {"state": "refused", "sentence": "No cell sis_x."}, 422),
        (TextError("No cell sis_x."), 422),
        (QueueFull("20 tasks wait."), 503),
        (ArboledaError("The plant is ending."), 503),
    ],
    ids=["refused", "text", "full", "ending"],
)
def test_a_refusal_says_why(web, plant, said, status):
    plant.answer = said
    answer = web.post("/api/tasks", json={"text": "sis_x"})
    assert answer.status_code == status
    assert answer.json()["sentence"] == (said["sentence"] if isinstance(said, dict) else str(said))


def test_a_plant_that_does_not_answer_is_said_to(web, plant, monkeypatch):
    monkeypatch.setattr("arboleda.adapters.web.ANSWER_S", 0.05)
    plant.answer = None
    answer = web.post("/api/tasks", json={"text": "sis_a 0B 7"})
    assert answer.status_code == 503
    assert "did not answer in time" in answer.json()["sentence"]


@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"sis_a 0B 7",
        b'"sis_a 0B 7"',
        b'{"text": 7}',
        b'{"text": null}',
        b'{"text": "a", "more": 1}',
        b'{"task": "a"}',
        b'{"text": "\\ud800"}',
        b"\xff\xfe",
        b"[" * 4000,
    ],
)
def test_a_body_that_is_no_task_is_refused_with_a_sentence(web, plant, body):
    answer = web.post("/api/tasks", content=body, headers={"content-type": "application/json"})
    assert answer.status_code == 422
    assert answer.json()["sentence"].startswith("The body must be JSON")
    assert plant.texts == []


def test_one_task_by_its_id(web):
    assert web.get("/api/tasks/t-1").json() == QUEUED
    unknown = web.get("/api/tasks/t-9")
    assert unknown.status_code == 404
    assert "'t-9'" in unknown.json()["sentence"]


@pytest.mark.parametrize(
    ("method", "path", "status"), [("GET", "/", 404), ("GET", "/docs", 404), ("PUT", "/api/plant", 405)]
)
def test_there_is_nothing_else(web, method, path, status):
    answer = web.request(method, path)
    assert answer.status_code == status
    assert answer.json()["sentence"]


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{port}", "127.0.0.1.evil.example", "", "[::2]:{port}"]
)
def test_a_foreign_host_is_turned_away(web, port, plant, host):
    answer = web.post("/api/tasks", json={"text": "x"}, headers={"host": host.format(port=port)})
    assert answer.status_code == 403
    assert plant.texts == []


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "https://127.0.0.1:{port}", "http://127.0.0.1:1"]
)
def test_a_foreign_origin_is_turned_away(web, port, plant, origin):
    answer = web.post("/api/tasks", json={"text": "x"}, headers={"origin": origin.format(port=port)})
    assert answer.status_code == 403
    assert plant.texts == []


@pytest.mark.parametrize("host", ["127.0.0.1:{port}", "localhost:{port}", "LOCALHOST", "[::1]:{port}"])
def test_our_own_names_and_origin_are_let_in(web, port, host):
    host = host.format(port=port)
    assert web.get("/api/plant", headers={"host": host, "origin": f"http://{host}"}).status_code == 200


def test_a_long_body_is_turned_away_with_and_without_a_length(web, port, plant):
    exact = b'{"text": "' + b"x" * (4096 - 12) + b'"}'
    assert web.post("/api/tasks", content=exact).status_code == 202
    assert web.post("/api/tasks", content=exact + b" ").status_code == 413
    chunked = http.client.HTTPConnection("127.0.0.1", port, timeout=5)
    chunked.request("POST", "/api/tasks", body=iter([b"x" * 3000, b"x" * 3000]), encode_chunked=True)
    assert chunked.getresponse().status == 413
    chunked.close()
    assert len(plant.texts) == 1


def test_an_error_of_ours_is_one_sentence_and_one_line(web, plant, caplog, capfd):
    plant.view = RuntimeError("boom")
    answer = web.get("/api/plant")
    assert (answer.status_code, answer.json()["sentence"]) == (
        500,
        "The plant could not answer: internal error.",
    )
    assert [record.getMessage() for record in caplog.records if record.name.startswith("arboleda")] == [
        "GET /api/plant failed: RuntimeError('boom')"
    ]
    assert "Traceback" not in capfd.readouterr().err


def test_a_taken_port_is_one_sentence(port, plant):
    with pytest.raises(StartError, match=f"cannot listen on 127.0.0.1:{port}: "):
        Api(plant.look, plant.find, plant.submit, port=port).start()


def test_it_stops_with_a_connection_open(plant):
    api = Api(plant.look, plant.find, plant.submit)
    kept = http.client.HTTPConnection("127.0.0.1", api.start(), timeout=5)
    kept.request("GET", "/api/plant")
    assert json.load(kept.getresponse()) == VIEW
    api.stop()
    api.stop()
    kept.close()


# --- app/client.py ---


@pytest.fixture
def state(port, tmp_path):
    with StateDir(tmp_path / "state") as made:
        made.announce(port)
        yield made


def test_the_client_submits_and_looks(state, monkeypatch):
    monkeypatch.setenv("http_proxy", "http://127.0.0.1:9")
    client = PlantClient(state.path)
    assert client.submit("sis_a 0B 7") == QUEUED
    assert client.status() == VIEW
    assert client.task("t-1") == QUEUED


@pytest.mark.parametrize("error", [TextError("No cell sis_x."), QueueFull("20 tasks wait.")])
def test_the_client_says_what_the_plant_said(state, plant, error):
    plant.answer = error
    with pytest.raises(type(error), match=str(error)):
        PlantClient(state.path).submit("x")


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
