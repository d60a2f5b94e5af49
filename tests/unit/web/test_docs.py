"""The description of the API, for tools and for people."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from tests.guarded_plant import PRESENT, shared_app
from tests.in_process import Caller, without_threads
from tests.packages import PACKAGES, leave_out
from tests.web_plant import Plant

from arboleda.client.answers.plant import Snapshot
from arboleda.model.messages import Verb
from arboleda.web.api import make_app
from arboleda.web.schema import openapi, queries
from arboleda.web.schema.answers import model_of


def test_the_description_has_every_route_and_what_it_takes_and_gives(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    leave_out(monkeypatch, tmp_path, *PACKAGES)
    api = Caller(make_app(Plant())).get("/api/openapi.json").json()
    assert set(api["paths"]) == {
        "/api/plant",
        "/api/recipes",
        "/api/assistants",
        "/api/history",
        "/api/history.csv",
        "/api/promises",
        "/api/tasks",
        "/api/tasks/{task_id}",
        "/api/plant/{verb}",
        "/api/acts/{number}",
        "/api/cells/{scope}/{verb}",
        "/api/events",
    }
    posted = api["paths"]["/api/tasks"]["post"]
    written, form = posted["requestBody"]["content"]["application/json"]["schema"]["anyOf"]
    assert written["required"] == ["text"]
    assert form["oneOf"] == [{"required": ["cell"]}, {"required": ["any_of"]}]
    assert {"202", "403", "422", "503", "default"} <= set(posted["responses"])
    assert {"Snapshot", "Cell", "Robot", "Task", "Done", "Sentence"} <= set(api["components"]["schemas"])
    assert not [name for name in api["components"]["schemas"] if "Validation" in name]


def test_models_of_answers_are_made_once_somebody_reads_the_description(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    described: list[object] = []

    def noted(answer: object) -> object:
        described.append(answer)
        return model_of(answer)

    monkeypatch.setattr(queries, "model_of", noted)
    app = make_app(PRESENT)
    assert described == []
    assert app.openapi() is app.openapi()
    assert Snapshot in described and described.count(Snapshot) == 1


def test_each_reference_leads_to_a_shape() -> None:
    api = shared_app().openapi()
    text = json.dumps(api)
    named = {f"#/components/schemas/{name}" for name in api["components"]["schemas"]}
    assert set(re.findall(r'"\$ref": ?"([^"]+)"', text)) <= named and "$defs" not in text


@pytest.fixture(scope="module")
def page() -> str:
    with pytest.MonkeyPatch.context() as patch:
        without_threads(patch)
        return Caller(shared_app()).get("/api/docs").text


def test_the_page_for_people_loads_nothing_and_links_lead_somewhere(page: str) -> None:
    assert "POST /api/cells/{scope}/{verb}" in page
    assert not re.findall(r"<script|<link|<img|src=|@import|https?://", page)
    assert set(re.findall(r'href="#(\w+)"', page)) <= set(re.findall(r'id="(\w+)"', page))


def test_every_verb_has_its_row_with_scope_deed_and_refusal(page: str) -> None:
    table = page.partition('<section id="Verb">')[2].partition("</section>")[0]
    rows = re.findall(r"<tr><th>(\w+)</th>(.+?)</tr>", table)
    assert [word for word, _ in rows[1:]] == [verb.value for verb in Verb]
    cells = dict(rows)["cancel"]
    assert "<td>a cell, a task</td>" in cells and "<code>cancelled</code>" in cells
    assert page.count('<a href="#Verb">') == 2


def test_a_state_of_a_cell_is_one_of_those_that_are_listed(page: str) -> None:
    assert "One of: idle, execute, holding, held," in page


def test_whatever_a_description_says_is_text() -> None:
    evil = "<script>alert(1)</script>"
    api = {
        "info": {"title": evil, "version": evil, "description": evil},
        "paths": {f"/{evil}": {"get": {"description": evil, "responses": {evil: {"description": evil}}}}},
        "components": {"schemas": {evil: {"properties": {evil: {"type": evil, "description": evil}}}}},
    }
    assert "<script" not in openapi.render(api)
