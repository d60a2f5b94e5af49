"""The routes of the HTTP API."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from urllib.parse import quote

import pytest
from fastapi import FastAPI
from starlette.requests import Request
from tests.guarded_plant import PRESENT, Web
from tests.in_process import Caller
from tests.web_plant import LATE, OFFER, OFFERS, QUEUED, TASK, VIEW, Plant

from arboleda.departures.leaving import STILL_WAITS, stop_left
from arboleda.model.errors import ArboledaError, QueueFull, TextError
from arboleda.model.messages import OperatorAnswer, Outcome, Verb
from arboleda.model.sentence import Phrase
from arboleda.store.task_rows import TaskQuery
from arboleda.web.api import make_app, own_up


def test_the_view_is_the_plant(web):
    answer = web.get("/api/plant")
    assert (answer.status_code, answer.json()) == (200, VIEW)


def test_a_good_text_is_queued(web, plant):
    answer = web.post("/api/tasks", json={"text": "sis_a 0B 7"})
    assert (answer.status_code, answer.json()) == (202, QUEUED)
    assert (plant.texts, plant.asked_by) == (["sis_a 0B 7"], ["http"])


def test_what_cells_offer_is_told_as_forms(web):
    assert web.get("/api/recipes").json() == OFFERS


def test_the_history_has_tasks_with_why_they_failed_as_data(web, plant):
    (row,) = web.get("/api/history?cell=sis_a").json()
    assert (row["id"], row["state"], row["sentence"]) == ("t-1", "failed", "ra1 was late")
    assert (row["key"], row["values"], row["accepted_s"]) == ("late", {"robot": "ra1"}, 1001.0)


def test_the_history_says_what_of_a_task_nobody_confirmed(web):
    assert [row["unchecked"] for row in web.get("/api/history").json()] == [["release"], []]


def test_the_history_is_asked_for_what_the_query_says(web, plant):
    said = "cell=sis_a&state=done&recipe=storage&words=lot&since=5&until=9.5&before=7&limit=3"
    assert web.get(f"/api/history?{said}").status_code == 200
    assert plant.queries == [
        TaskQuery(
            cell="sis_a",
            state="done",
            recipe="storage",
            words="lot",
            since_s=5,
            until_s=9.5,
            before=7,
            limit=3,
        )
    ]


def test_the_history_is_a_table_for_other_programs(web):
    answer = web.get("/api/history.csv")
    assert answer.headers["content-type"] == "text/csv; charset=utf-8"
    names, *rows = answer.text.splitlines()
    assert names.startswith("number,id,text,cell,recipe,state,reason,sentence")
    assert [row.split(",")[1] for row in rows] == ["t-2", "t-1"]


@pytest.mark.parametrize(
    ("query", "sentence"),
    [
        ("limit=0", "'limit' is '0': input should be greater than or equal to 1."),
        ("state=lost", "'state' is 'lost': input should be"),
        ("since=monday", "'since' is 'monday': input should be a valid number"),
        ("colour=red", "'colour' is nothing to ask for; there are cell, state, recipe, words, since"),
    ],
)
def test_a_wrong_query_is_refused_with_what_is_wrong(web, plant, query, sentence):
    answer = web.get(f"/api/history?{query}")
    assert answer.status_code == 422 and answer.json()["sentence"].startswith(sentence)
    assert web.get(f"/api/history.csv?{query}").json() == answer.json()
    assert plant.queries == []


def test_what_cells_promise_is_told(web):
    rows = web.get("/api/promises", params={"text": "sis_a,sis_b 0b 7"}).json()
    assert [(row["cell"], row["text"]) for row in rows] == [("sis_a", "sis_a 0B 7"), ("sis_b", "sis_b 0B 7")]
    refused = web.get("/api/promises", params={"text": "sis_z 0b 7"})
    assert refused.status_code == 422 and "'sis_z' is not a cell" in refused.json()["sentence"]


def test_why_a_task_was_given_to_a_plant_comes_with_it(web, plant):
    assert web.post("/api/tasks", json={"text": "sis_a 0B 7", "why": "it is first"}).status_code == 202
    assert plant.choices == ["it is first"]


def test_a_form_for_several_cells_names_them_all(web, plant):
    form = {"any_of": ["sis_b", "sis_a"], "values": {"station": 7, "path": "0b"}, "id": "lot1"}
    assert web.post("/api/tasks", json=form).status_code == 202
    assert plant.texts == ["sis_b,sis_a 0B 7 #lot1"]


def test_a_form_is_queued_as_the_text_that_it_spells(web, plant):
    form = {"cell": "sis_a", "values": {"station": 7, "path": "0b"}, "id": "lot1"}
    assert web.post("/api/tasks", json=form).status_code == 202
    assert web.post("/api/tasks", json={"cell": "sis_a", "recipe": "palletizing"}).status_code == 202
    assert plant.texts == ["sis_a 0B 7 #lot1", "sis_a palletizing"]


@pytest.mark.parametrize(
    ("form", "sentence"),
    [
        ({"cell": "sis_z"}, "'sis_z' is not a cell of this plant"),
        ({"cell": "sis_a", "recipe": "palet"}, "'palet' is not a recipe of sis_a"),
        ({"cell": "sis_a", "values": {"path": "0B"}}, "storage of sis_a needs a value for station"),
        ({"any_of": ["sis_a", "sis_z"], "recipe": "palletizing"}, "'sis_z' is not a cell of this plant"),
        ({"cell": "sis_a", "values": {"path": "0B 7", "station": 7}}, "'0B 7' is not a path of sis_a"),
    ],
)
def test_a_wrong_form_is_refused_with_what_is_wrong(web, plant, form, sentence):
    answer = web.post("/api/tasks", json=form)
    assert answer.status_code == 422 and answer.json()["sentence"].startswith(sentence)
    assert answer.json()["key"] and plant.texts == []


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
    assert ("retry-after" in answer.headers) == isinstance(said, QueueFull)


@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"sis_a 0B 7",
        b'"sis_a 0B 7"',
        b'{"text": 7}',
        b'{"text": "a", "more": 1}',
        b'{"cell": "a", "text": "b"}',
        b'{"cell": "a", "values": {"path": null}}',
        b'{"cell": "a", "any_of": ["a", "b"]}',
        b'{"recipe": "palletizing"}',
        b'{"cell": "a", "values": {"path": ["0B"]}}',
        b'{"text": "\\ud800"}',
        b"\xff\xfe",
        b"[" * 4000,
    ],
)
def test_a_body_that_is_no_task_is_refused_with_a_sentence(web, plant, body):
    answer = web.post("/api/tasks", content=body, headers={"content-type": "application/json"})
    assert answer.status_code == 422
    assert answer.json()["sentence"].startswith(
        f'The body must be JSON like {{"text": "{OFFER["example"]}"}} or '
    )
    assert plant.texts == []


def test_the_tasks_are_listed_as_the_view_has_them(web, plant):
    assert web.get("/api/tasks").json() == [TASK]
    plant.becomes(tasks=[])
    assert web.get("/api/tasks").json() == []


def test_one_task_by_its_id(web):
    assert web.get("/api/tasks/t-1").json() == QUEUED
    unknown = web.get("/api/tasks/t-9")
    assert unknown.status_code == 404
    assert "'t-9'" in unknown.json()["sentence"]


@pytest.mark.parametrize("verb", Verb)
def test_a_verb_reaches_the_plant_with_its_scope(web, plant, verb):
    answer = web.post(f"/api/cells/sis_a/{verb.value}")
    assert (answer.status_code, answer.json()) == (200, {"verb": verb.value, "scope": "sis_a"})
    assert plant.acts == [(verb, "sis_a", False)]


def test_a_verb_is_for_the_whole_plant_or_for_one_task(web, plant):
    assert web.post("/api/plant/stop").json() == {"verb": "stop", "scope": ""}
    assert web.post("/api/cells/lot.4-2/cancel").json() == {"verb": "cancel", "scope": "lot.4-2"}
    assert plant.acts == [(Verb.STOP, "", False), (Verb.CANCEL, "lot.4-2", False)]


@pytest.mark.parametrize(
    ("body", "by_hand"), [(b"{}", False), (b'{"by_hand": false}', False), (b'{"by_hand": true}', True)]
)
def test_homed_by_hand_is_declared_in_the_body(web, plant, body, by_hand):
    assert web.post("/api/cells/ra1/home", content=body).status_code == 200
    assert plant.acts == [(Verb.HOME, "ra1", by_hand)]


@pytest.mark.parametrize(
    ("scope", "body", "meant"),
    [
        ("ana", {"answer": "not yet"}, [("answer", "not yet")]),
        ("ana", {"answer": "yes", "question": "1000-12"}, [("question", "1000-12"), ("answer", "yes")]),
        ("ana yes", None, [("answer", "yes")]),
        ("ana #1000-12 yes", {}, [("question", "1000-12"), ("answer", "yes")]),
    ],
)
def test_a_person_is_answered_by_arguments_or_within_the_address(web, plant, scope, body, meant):
    answer = web.post(f"/api/cells/{quote(scope)}/answer", json=body)
    assert (answer.status_code, answer.json()["scope"]) == (200, scope)
    assert plant.acts == [(Verb.ANSWER, "ana", False, *meant)]


@pytest.mark.parametrize(("scope", "body"), [("sis_a", {"station": 7}), ("sis_a 7", None)])
def test_a_station_is_unloaded_by_its_number_or_within_the_address(web, plant, scope, body):
    assert web.post(f"/api/cells/{quote(scope)}/unload", json=body).status_code == 200
    assert plant.acts == [(Verb.UNLOAD, "sis_a", False, ("station", 7))]


@pytest.mark.parametrize(
    ("verb", "body"),
    [
        ("hold", {"answer": "yes"}),
        ("answer", {"question": "1000-12"}),
        ("answer", {"station": 7}),
        ("unload", {"station": "7"}),
        ("unload", {"station": -1}),
        ("answer", {"answer": ""}),
        ("answer", {"answer": "yes", "question": "1 no"}),
    ],
)
def test_arguments_that_do_not_belong_to_a_verb_are_refused(web, plant, verb, body):
    assert web.post(f"/api/cells/ana/{verb}", json=body).status_code == 422
    assert plant.acts == []


def test_a_refused_verb_says_why(web, plant):
    plant.refusal = "ra1 still moves."
    answer = web.post("/api/plant/clear")
    assert (answer.status_code, answer.json()) == (409, {"sentence": "ra1 still moves."})


def test_a_refusal_says_what_it_is_made_of(web, plant):
    full = Phrase("cell.full", "{cell} has {number} tasks waiting")(cell="sis_a", number=20)
    said = {
        "sentence": "sis_a has 20 tasks waiting",
        "key": "cell.full",
        "values": {"cell": "sis_a", "number": 20},
    }
    plant.refusal = full
    assert web.post("/api/plant/clear").json() == said
    plant.answer = QueueFull(full)
    assert web.post("/api/tasks", json={"text": "sis_a 0B 7"}).json() == said
    plant.answer = QUEUED | {"state": "refused", "sentence": full}
    assert web.post("/api/tasks", json={"text": "sis_a 0B 7"}).json() == QUEUED | {"state": "refused"} | said


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


@pytest.fixture
def impatient(monkeypatch):
    """The API waits for no answer that is not there yet."""
    monkeypatch.setattr("arboleda.web.api.ANSWER_S", 0)


@pytest.mark.usefixtures("impatient")
def test_a_plant_that_does_not_answer_is_said_to(web, plant):
    plant.answer = None
    answer = web.post("/api/tasks", json={"text": "sis_a 0B 7"})
    assert answer.status_code == 503
    assert "did not answer in time" in answer.json()["sentence"]


@pytest.mark.usefixtures("impatient")
def test_a_verb_that_is_answered_late_is_said_to_be_so(web, plant):
    plant.unanswered = []
    answer = web.post("/api/plant/stop")
    assert answer.status_code == 503
    assert "did not answer in time" in answer.json()["sentence"]
    plant.unanswered[0].set_result(OperatorAnswer(verb=Verb.STOP, scope=""))


def test_a_stop_that_has_left_and_is_not_kept_is_said_to(web, plant):
    plant.unkept = STILL_WAITS()
    answer = web.post("/api/cells/sis_a/stop")
    assert answer.status_code == 202
    left = stop_left(OperatorAnswer(verb=Verb.STOP, scope="sis_a"), plant.unkept)
    assert answer.json() == {"verb": "stop", "scope": "sis_a", "outcome": "sent", "why": str(left.why)}


@pytest.fixture(scope="module")
def paged() -> FastAPI:
    """An application beside a page that takes every path."""
    app = make_app(PRESENT)

    @app.api_route("/{path:path}", methods=["GET", "POST", "PUT", "DELETE"])
    async def page(path: str) -> str:
        return "a page"

    return app


@pytest.fixture
def beside_a_page(serve: Callable[..., Web], paged: FastAPI) -> Caller:
    web = serve(behind=paged)
    return web.client(origin=web.origin, accept="text/html")


@pytest.fixture
def browser(local: Web) -> Caller:
    return local.client(origin=local.origin, accept="text/html")


OTHER_METHODS = [
    ("PUT", "/api/plant", "GET"),
    ("HEAD", "/api/plant", "GET"),
    ("DELETE", "/api/tasks", "GET, POST"),
    ("DELETE", "/api/tasks/t-1", "GET"),
    ("GET", "/api/plant/stop", "POST"),
    ("OPTIONS", "/api/cells/sis_a/stop", "POST"),
    ("PUT", "/login", "GET, POST"),
]
NO_PATHS = ["/api", "/api/", "/api/nothing", "/api/plant/", "/api/cells/sis_a"]


@pytest.mark.parametrize(("method", "path", "allowed"), OTHER_METHODS)
def test_another_method_is_405_and_says_which_there_are(
    browser: Caller, plant: Plant, method: str, path: str, allowed: str
) -> None:
    answer = browser.request(method, path)
    assert (answer.status_code, answer.headers["allow"]) == (405, allowed)
    assert (plant.acts, plant.texts) == ([], [])


@pytest.mark.parametrize("method", ["GET", "POST"])
@pytest.mark.parametrize("path", NO_PATHS)
def test_an_unknown_path_of_the_api_is_a_404_in_json(browser: Caller, path: str, method: str) -> None:
    answer = browser.request(method, path)
    assert (answer.status_code, answer.headers["content-type"]) == (404, "application/json")
    assert answer.json() == {"sentence": "There is nothing here; /api/docs lists what there is."}


@pytest.mark.parametrize("path", ["/", "/docs"])
def test_without_a_page_there_is_nothing_else(web: Caller, path: str) -> None:
    answer = web.get(path)
    assert answer.status_code == 404 and answer.json()["sentence"]


def test_a_page_that_takes_every_path_takes_none_of_the_api(beside_a_page: Caller) -> None:
    assert beside_a_page.get("/").json() == "a page"
    wrong = {(method, path): 405 for method, path, _ in OTHER_METHODS}
    wrong |= {("GET", path): 404 for path in NO_PATHS}
    assert {asked: beside_a_page.request(*asked).status_code for asked in wrong} == wrong


@pytest.mark.parametrize(
    ("path", "sentence"),
    [
        ("acts/x", "'number' is 'x': input should be a valid integer, unable to parse string as an integer."),
        ("promises", "'text' is missing; /api/docs says what to give."),
    ],
)
def test_a_wrong_part_of_an_address_is_named(web, path, sentence):
    answer = web.get(f"/api/{path}")
    assert (answer.status_code, answer.json()) == (422, {"sentence": sentence})


def test_what_fails_because_its_caller_has_gone_is_not_logged(caplog):
    async def gone():
        return {"type": "http.disconnect"}

    request = Request(
        {"type": "http", "method": "GET", "path": "/", "headers": [], "query_string": b""}, gone
    )
    asyncio.run(own_up(request, RuntimeError("No response returned.")))
    assert not caplog.records
    asyncio.run(own_up(request, RuntimeError("boom")))
    assert [record.getMessage() for record in caplog.records] == ["GET / failed: RuntimeError: boom"]


def test_what_devices_do_is_answered_as_under_way_with_the_number_that_tells_its_end(web, plant):
    plant.told = {"act": 7, "outcome": Outcome.UNDER_WAY}
    answer = web.post("/api/cells/jaw/release")
    assert answer.status_code == 202
    assert answer.json() == {"verb": "release", "scope": "jaw", "act": 7, "outcome": "under_way"}
    plant.rows[7] = {"number": 7, "outcome": "failed", "why": LATE}
    row = web.get("/api/acts/7")
    assert (row.status_code, row.json()) == (200, {"number": 7, "outcome": "failed", "why": str(LATE)})


def test_an_act_that_failed_at_once_says_why(web, plant):
    plant.told = {"act": 7, "outcome": Outcome.FAILED, "why": LATE}
    answer = web.post("/api/cells/jaw/release")
    assert (answer.status_code, answer.json()["why"]) == (200, str(LATE))


def test_an_act_that_nobody_knows_any_more_is_not_found(web):
    answer = web.get("/api/acts/1")
    assert (answer.status_code, "no act 1" in answer.json()["sentence"]) == (404, True)
