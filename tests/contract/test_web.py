"""The HTTP API over real sockets, and the client of the commands."""

from __future__ import annotations

import http.client
import json
import os
import threading
from concurrent.futures import Future

import httpx
import pytest

from arboleda.adapters.web import Api
from arboleda.app.client import PlantClient, Refused
from arboleda.app.state import StateDir
from arboleda.core.errors import ArboledaError, QueueFull, StartError, TextError
from arboleda.core.messages import OperatorAnswer, Verb

QUEUED = {"id": "t-1", "text": "sis_a 0b 7", "cell": "sis_a", "state": "queued", "sentence": ""}
VIEW = {"plant": "demo", "tasks": [QUEUED]}


class Plant:
    """Answers each text with what was prepared for it."""

    def __init__(self) -> None:
        self.texts: list[str] = []
        self.answer: dict | Exception | None = QUEUED
        self.view: dict | Exception = VIEW
        self.acts: list[tuple[Verb, str, bool]] = []
        self.refusal: str | None = None
        self.unanswered: list[Future] | None = None

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

    def operate(self, verb: Verb, scope: str, *, by_hand: bool) -> Future:
        self.acts.append((verb, scope, by_hand))
        future: Future = Future()
        if self.unanswered is not None:
            self.unanswered.append(future)
        else:
            future.set_result(OperatorAnswer(verb=verb, scope=scope, refusal=self.refusal))
        return future


@pytest.fixture
def plant():
    return Plant()


@pytest.fixture
def port(plant):
    api = Api(plant.look, plant.find, plant.submit, plant.operate)
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


@pytest.mark.parametrize("verb", Verb)
@pytest.mark.parametrize(
    ("path", "scope"), [("plant", ""), ("cells/sis_a", "sis_a"), ("cells/lot.4-2", "lot.4-2")]
)
def test_a_verb_reaches_the_plant_with_its_scope(web, plant, verb, path, scope):
    answer = web.post(f"/api/{path}/{verb.value}")
    assert (answer.status_code, answer.json()) == (200, {"verb": verb.value, "scope": scope})
    assert plant.acts == [(verb, scope, False)]


@pytest.mark.parametrize(
    ("body", "by_hand"), [(b"{}", False), (b'{"by_hand": false}', False), (b'{"by_hand": true}', True)]
)
def test_homed_by_hand_is_declared_in_the_body(web, plant, body, by_hand):
    assert web.post("/api/cells/ra1/home", content=body).status_code == 200
    assert plant.acts == [(Verb.HOME, "ra1", by_hand)]


def test_a_refused_verb_says_why(web, plant):
    plant.refusal = "ra1 still moves."
    answer = web.post("/api/plant/clear")
    assert (answer.status_code, answer.json()) == (409, {"sentence": "ra1 still moves."})


@pytest.mark.parametrize("path", ["plant/halt", "cells/sis_a/STOP", "cells/stop/sis_a"])
def test_an_unknown_verb_names_the_verbs(web, plant, path):
    answer = web.post(f"/api/{path}")
    assert answer.status_code == 422
    assert "there are stop, clear, reset, hold" in answer.json()["sentence"]
    assert plant.acts == []


@pytest.mark.parametrize(
    "body",
    [b"true", b'{"by_hand": 1}', b'{"by_hand": null}', b'{"more": 1}', b"by_hand", b"\xff", b"[" * 4000],
)
def test_a_body_that_means_nothing_stops_nothing(web, plant, body):
    answer = web.post("/api/plant/stop", content=body)
    assert answer.status_code == 422
    assert answer.json()["sentence"].startswith("The body may be empty")
    assert plant.acts == []


def test_a_verb_that_is_answered_late_is_said_to_be_so(web, plant, monkeypatch):
    monkeypatch.setattr("arboleda.adapters.web.ANSWER_S", 0.05)
    plant.unanswered = []
    answer = web.post("/api/plant/stop")
    assert answer.status_code == 503
    assert "did not answer in time" in answer.json()["sentence"]
    plant.unanswered[0].set_result(OperatorAnswer(verb=Verb.STOP, scope=""))


@pytest.mark.parametrize("headers", [{"host": "evil.example"}, {"origin": "http://evil.example"}])
def test_a_page_of_another_site_operates_nothing(web, plant, headers):
    assert web.post("/api/plant/release", headers=headers).status_code == 403
    assert plant.acts == []


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [("GET", "/", 404), ("GET", "/docs", 404), ("PUT", "/api/plant", 405), ("GET", "/api/plant/stop", 405)],
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
        Api(plant.look, plant.find, plant.submit, plant.operate, port=port).start()


def test_it_stops_with_a_connection_open(plant):
    api = Api(plant.look, plant.find, plant.submit, plant.operate)
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


def test_the_client_operates_the_plant_or_one_thing_of_it(state, plant):
    client = PlantClient(state.path)
    assert client.operate(Verb.STOP) == {"verb": "stop", "scope": ""}
    assert client.operate(Verb.HOME, "ra1", by_hand=True) == {"verb": "home", "scope": "ra1"}
    assert plant.acts == [(Verb.STOP, "", False), (Verb.HOME, "ra1", True)]
    plant.refusal = "ra1 still moves."
    with pytest.raises(Refused, match=r"^ra1 still moves\.$"):
        client.operate(Verb.CLEAR, "sis_a")


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
