"""The description of the API, for tools and for people."""

from __future__ import annotations

import re

import httpx

from arboleda.adapters.web import listing


def test_the_description_has_every_route_and_what_it_takes_and_gives(web: httpx.Client) -> None:
    api = web.get("/api/openapi.json").json()
    assert set(api["paths"]) == {
        "/api/plant",
        "/api/tasks",
        "/api/tasks/{task_id}",
        "/api/plant/{verb}",
        "/api/cells/{scope}/{verb}",
        "/api/events",
    }
    posted = api["paths"]["/api/tasks"]["post"]
    assert posted["requestBody"]["content"]["application/json"]["schema"]["required"] == ["text"]
    assert {"202", "403", "422", "503", "default"} <= set(posted["responses"])
    assert {"Snapshot", "Cell", "Robot", "Task", "Done", "Sentence"} <= set(api["components"]["schemas"])
    assert not [name for name in api["components"]["schemas"] if "Validation" in name]


def test_the_page_for_people_loads_nothing_and_links_lead_somewhere(web: httpx.Client) -> None:
    page = web.get("/api/docs").text
    assert "POST /api/cells/{scope}/{verb}" in page
    assert not re.findall(r"<script|<link|<img|src=|@import|https?://", page)
    assert set(re.findall(r'href="#(\w+)"', page)) <= set(re.findall(r'id="(\w+)"', page))


def test_whatever_a_description_says_is_text(web: httpx.Client) -> None:
    evil = "<script>alert(1)</script>"
    api = {
        "info": {"title": evil, "version": evil, "description": evil},
        "paths": {f"/{evil}": {"get": {"description": evil, "responses": {evil: {"description": evil}}}}},
        "components": {"schemas": {evil: {"properties": {evil: {"type": evil, "description": evil}}}}},
    }
    assert "<script" not in listing.render(api)
