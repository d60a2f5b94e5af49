"""What takes the real server: its threads, logins and sessions, and the client of the commands."""

import socket
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from tests.patience import PATIENCE_S
from tests.web_plant import QUEUED, TOKENS, VIEW, Plant

from arboleda.cli.client import PlantClient
from arboleda.client import NoAnswer
from arboleda.runtime.state import StateDir
from arboleda.web.access.auth import Role

from .conftest import Web


def test_a_stop_does_not_wait_behind_a_task_whose_id_is_looked_for(web, local, plant, monkeypatch):
    reached, let_go, submit = threading.Event(), threading.Event(), plant.submit

    def look(*asked):
        reached.set()
        assert let_go.wait(PATIENCE_S)
        return submit(*asked)

    monkeypatch.setattr(plant, "submit", look)
    with ThreadPoolExecutor(1) as pool:
        task = pool.submit(lambda: local.client().post("/api/tasks", json={"text": "sis_a 0B 7 #lot42"}))
        assert reached.wait(PATIENCE_S)
        assert web.post("/api/plant/stop").status_code == 200
        assert not task.done()
        let_go.set()
        assert task.result().status_code == 202


def test_an_error_of_ours_is_one_sentence_and_one_line(web, plant, caplog, capfd):
    plant.view = RuntimeError("boom")
    answer = web.get("/api/plant")
    assert (answer.status_code, answer.json()["sentence"]) == (
        500,
        "The plant could not answer: internal error.",
    )
    assert [record.getMessage() for record in caplog.records if record.name.startswith("arboleda")] == [
        "GET /api/plant failed: RuntimeError: boom"
    ]
    assert "Traceback" not in capfd.readouterr().err


def test_a_session_does_what_its_role_may_until_logout(open_to_all: Web) -> None:
    viewer, operator = (open_to_all.client(origin=open_to_all.origin) for _ in range(2))
    assert viewer.post("/login", data={"token": TOKENS[Role.VIEWER]}).status_code == 303
    assert operator.post("/login", data={"token": TOKENS[Role.OPERATOR]}).status_code == 303
    assert [each.post("/api/plant/reset").status_code for each in (viewer, operator)] == [403, 200]
    stolen = operator.cookies[open_to_all.cookie]
    assert operator.post("/logout").headers["location"] == "/login"
    assert open_to_all.cookie not in operator.cookies
    thief = open_to_all.client(origin=open_to_all.origin, cookie=f"{open_to_all.cookie}={stolen}")
    assert thief.post("/api/plant/stop").status_code == 401


def test_the_client_submits_and_looks_whatever_proxy_there_is(
    local: Web, plant: Plant, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("http_proxy", "http://127.0.0.1:9")
    with StateDir(tmp_path) as made:
        made.announce(local.port)
        client = PlantClient(tmp_path)
        assert client.submit("sis_a 0B 7") == QUEUED
        assert client.status() == VIEW and client.task("t-1") == QUEUED
    assert (plant.texts, plant.asked_by) == (["sis_a 0B 7"], ["command"])


def test_a_process_that_cuts_a_connection_has_not_answered(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener, StateDir(tmp_path) as made:
        cutting = threading.Thread(target=lambda: listener.accept()[0].close())
        cutting.start()
        made.announce(listener.getsockname()[1])
        with pytest.raises(NoAnswer, match=r"did not answer\.") as silent:
            PlantClient(tmp_path).submit("sis_a 0B 7")
        cutting.join()
    assert silent.value.may_have_heard
