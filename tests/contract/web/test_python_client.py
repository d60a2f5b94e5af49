"""`arboleda.client` against the real server: what it returns, what it raises, what it goes on after."""

from __future__ import annotations

import asyncio
import json
import os
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from arboleda.client import (
    AsyncPlant,
    Conflict,
    Forbidden,
    Later,
    LibraryMissing,
    NoAnswer,
    NotFound,
    OtherPlant,
    PlantError,
    Rows,
    StillRunning,
    Unauthorized,
    WrongRequest,
)
from arboleda.client import Plant as Client
from arboleda.model.errors import QueueFull, TextError
from arboleda.model.messages import Outcome, Verb
from arboleda.runtime.standby.leader import LeaderInfo
from arboleda.runtime.standby.waiting_room import WaitingRoom
from arboleda.runtime.web_options import WebOptions
from arboleda.web.access.auth import Role

from ...patience import PATIENCE_S
from .conftest import KEPT, LATE, QUEUED, TASK, TOKENS, VIEW, Plant, Web, running

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
    client.submit_form(cell="sis_a", values={"path": "0B", "station": 7}, id="lot43")
    assert plant.forms == [("sis_a", "", {"path": "0B", "station": 7}, "lot43")]
    assert client.snapshot().tasks == client.tasks() and client.task("t-1").id == "t-1"
    assert client.recipes()[0].recipes[0].parameters[0].choices == ["5"]
    assert client.promises("sis_a,sis_b 0B 7")[1].cell == "sis_b"
    assert client.oee(cell="sis_a")[0].failed == 1


def test_the_history_comes_as_rows_and_as_a_table(client: Client, plant: Plant) -> None:
    rows = client.history(state="failed", limit=20)
    assert [row.number for row in rows] == [row.number for row in KEPT]
    assert rows[0].unchecked == ["release"] and rows[0].key == LATE.key and rows[0].values == {"robot": "ra1"}
    assert (plant.queries[-1].state, plant.queries[-1].limit) == ("failed", 20)
    assert client.history_csv(cell="sis_a").startswith("number,id,text,cell,")


def test_rows_are_a_frame_of_pandas_or_say_how_to_get_it(
    client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Pandas:
        DataFrame = staticmethod(lambda rows: rows)

    rows = client.history()
    monkeypatch.setitem(sys.modules, "pandas", Pandas)
    assert rows.to_pandas()[0]["cell"] == "sis_b"
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(LibraryMissing, match="pip install pandas"):
        Rows(rows).to_pandas()


@pytest.mark.parametrize(("raised", "error"), [(TextError, WrongRequest), (QueueFull, Later)])
def test_a_refusal_of_the_plant_is_an_error_with_its_sentence_as_data(
    client: Client, plant: Plant, raised: type, error: type
) -> None:
    plant.answer = raised(LATE)
    with pytest.raises(raised, match=r"^ra1 was late$") as refused:
        client.submit("sis_x")
    assert isinstance(refused.value, error)
    assert (refused.value.key, refused.value.values) == ("late", {"robot": "ra1"})
    assert refused.value.retry_after_s == (10.0 if error is Later else None)


def test_a_task_that_is_refused_is_an_error_too(client: Client, plant: Plant) -> None:
    plant.answer = TASK | {"state": "refused", "sentence": "There is no sis_x."}
    with pytest.raises(WrongRequest, match=r"^There is no sis_x\.$") as refused:
        client.submit("sis_x 0B 7")
    assert refused.value.data["state"] == "refused"


def test_verbs_carry_their_arguments(client: Client, plant: Plant) -> None:
    plant.told = {"act": 4, "outcome": Outcome.UNDER_WAY}
    assert client.operate(Verb.HOME, "ra1", by_hand=True).act == 4
    client.operate("answer", "ana", answer="yes")
    assert client.stop().verb == "stop"
    assert plant.acts == [
        (Verb.HOME, "ra1", True),
        (Verb.ANSWER, "ana", False, ("answer", "yes")),
        (Verb.STOP, "", False),
    ]
    plant.refusal = "ra1 still moves."
    with pytest.raises(Conflict, match=r"^ra1 still moves\.$"):
        client.operate("clear", "sis_a")
    with pytest.raises(WrongRequest, match="is not an operator's verb"):
        client.operate("explode")


def test_an_act_is_followed_to_its_end(client: Client, plant: Plant) -> None:
    row = {"number": 4, "at": 1.0, "verb": "home", "scope": "ra1", "cell": None, "sentence": ""}
    row |= {"why": None, "ended_at": None, "ended": None}
    outcomes = iter(["under_way", "done"])
    plant.act = lambda number: row | {"outcome": next(outcomes)}
    assert client.outcome(4).outcome == "done"


def test_the_report_of_a_task_is_waited_for(client: Client, plant: Plant) -> None:
    said = {"sentence": "ra1 was late", "key": "late", "values": {"robot": "ra1"}}
    evidence = {"troubles": [], "last_command": None, "acts": [], "foreign": []}
    facts = {
        "task": "lot",
        "text": "",
        "cell": "sis_a",
        "ended_s": 1.0,
        "reason": "deadline",
        "failure": said,
    }
    facts["cause"] = said | {"kind": "unended", "robot": "ra1"}
    facts["evidence"] = evidence | {"absences": [{"at_s": -1.0, "seconds": 0.5}]}
    page = '<script type="application/json" id="data">{}</script>'
    plant.reports = iter([None, page.replace("{}", json.dumps({"scene": {}, "facts": facts})), page])
    report = client.report("lot")
    assert report.state == "written" and report.cause and report.cause.kind == "unended"
    assert report.evidence and report.evidence.absences[0].seconds == 0.5
    with pytest.raises(NotFound, match="an earlier version"):
        client.report("lot")


def test_the_draft_is_edited_under_one_id(client: Client, plant: Any) -> None:
    steps: list[tuple[Any, ...]] = []
    state = {"file": "plant.yaml", "editor": None, "changes": [], "waiting": [], "undo": 0, "redo": 0}
    state |= {"values": {}, "trees": [], "restart": [], "is_ours": True}
    applied = {"problems": [], "warnings": [], "version": 3, "cells": {"lab": "now"}, "cancelled": []}

    class Desk:
        def __getattr__(self, name: str) -> Any:
            return lambda *told: steps.append((name, *told)) or applied | state

    plant.draft = Desk()
    draft = client.draft("ana-12345")
    assert draft.state().file == "plant.yaml" and draft.take("Ana").is_ours
    draft.set(["cells", "lab", "targets", 0], [1, {"b": None}])
    assert draft.apply("why").cells == {"lab": "now"} and draft.check().problems == []
    assert steps == [
        ("state",),
        ("take", "ana-12345", "Ana"),
        ("set", "ana-12345", ("cells", "lab", "targets", 0), [1, {"b": None}]),
        ("apply", "ana-12345", "why"),
        ("check",),
    ]
    with pytest.raises(WrongRequest, match="place"):
        client.draft().remove([])


def test_what_is_not_there_or_not_allowed_is_told_apart(client: Client, open_to_all: Web) -> None:
    with pytest.raises(NotFound, match="knows no task 'lot'"):
        client.task("lot")
    with pytest.raises(NotFound, match="knows no act 7"):
        client.act(7)
    with Client(open_to_all.origin) as nobody, pytest.raises(Unauthorized, match="token"):
        nobody.snapshot()
    with Client(open_to_all.origin, token=TOKENS[Role.VIEWER]) as viewer:
        assert viewer.snapshot().plant == "demo" and viewer.stop().verb == "stop"
        with pytest.raises(Forbidden, match="operator's token"):
            viewer.submit("sis_a 0B 7")


def test_another_plant_at_the_address_gets_nothing_done(serve: Callable[..., Web], plant: Plant) -> None:
    web = serve(name="demo")
    with Client(web.origin, plant="other", patience_s=0.0) as client, pytest.raises(OtherPlant, match="demo"):
        client.submit("sis_a 0B 7")
    assert plant.texts == []


def test_nobody_and_nonsense_are_said_to_be_that(free_port: int) -> None:
    nobody, reason = f"http://127.0.0.1:{free_port}", f"cannot be reached at http://127.0.0.1:{free_port}"
    with Client(nobody, patience_s=0.0) as client, pytest.raises(NoAnswer, match=reason) as silent:
        client.snapshot()
    assert not silent.value.may_have_heard
    with Client("no address", patience_s=0.0) as client, pytest.raises(PlantError):
        client.snapshot()


def ended(state: str) -> dict[str, Any]:
    return TASK | {"state": state}


def test_a_task_is_followed_to_its_end_by_the_events(client: Client, plant: Plant) -> None:
    states = iter(["queued", "running", "done"])
    plant.find = lambda id: ended(next(states)) if id == "t-1" else None
    followed = client.follow("t-1")
    assert next(followed).state == "queued"
    plant.becomes(tasks=[ended("running")])
    assert next(followed).state == "running"
    plant.becomes(tasks=[ended("done")])
    assert [task.state for task in followed] == ["done"]


def test_who_waits_too_short_is_told_how_the_task_stands(client: Client) -> None:
    with pytest.raises(StillRunning, match="#t-1 has not ended yet, it is queued") as still:
        client.wait("t-1", within_s=0.1)
    assert still.value.task.id == "t-1"


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


def test_a_leader_that_a_standby_names_is_followed(local: Web, tmp_path: Path, plant: Plant) -> None:
    here = LeaderInfo(plant="demo", host="", process=7, url=local.origin, epoch=7)
    room = WaitingRoom("demo", tmp_path, WebOptions(port=0))
    room.start(lambda *_, **__: None)
    try:
        room.show("waits for its end", replace(here, host=os.uname().nodename))
        with Client(room.url, patience_s=0.0) as client:
            assert client.submit("sis_a 0B 7").state == "queued"
            assert next(client.events()).kind == "snapshot" and client.stop().verb == "stop"
        room.show("begins to wait", None)
        with Client(room.url, patience_s=0.0) as client, pytest.raises(NoAnswer, match="it begins to wait"):
            client.submit("sis_a 0B 7")
    finally:
        room.stop()
    assert len(plant.texts) == 1


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
