"""What of the HTTP API takes the real server: its threads, and what it writes itself."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor

from tests.patience import PATIENCE_S


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
