"""The routes of the draft: who may, what they take, and what they answer."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.web.access.auth import Role
from arboleda_make.drafts.api import DraftApi, DraftRefused

VALUE = [1, {"b": None}]
STATE = {"file": "plant.yaml", "editor": None, "changes": [], "waiting": [], "undo": 0, "redo": 0}
STATE |= {"values": {}}
EDITOR = {"editor": "ana-12345"}
STEPS = {
    "take": (EDITOR | {"name": "Ana"}, ("take", "ana-12345", "Ana")),
    "set": (
        EDITOR | {"place": ["a", 0], "value": VALUE, "of": "4f"},
        ("set", "ana-12345", ("a", 0), VALUE, "4f"),
    ),
    "remove": (EDITOR | {"place": ["a"]}, ("remove", "ana-12345", ("a",))),
    "undo": (EDITOR, ("undo", "ana-12345")),
    "redo": (EDITOR, ("redo", "ana-12345")),
    "discard": (EDITOR, ("discard", "ana-12345")),
    "keep": (EDITOR | {"note": "why"}, ("keep", "ana-12345", "why")),
    "check": ({}, ("check",)),
    "apply": (EDITOR | {"note": "why"}, ("apply", "ana-12345", "why")),
    "set_trees": (EDITOR | {"file": "a.xml", "text": "<a/>"}, ("set_trees", "ana-12345", "a.xml", "<a/>")),
    "remove_trees": (EDITOR | {"file": "a.xml"}, ("remove_trees", "ana-12345", "a.xml")),
    "own": (EDITOR, ("own", "ana-12345")),
}


class Draft:
    """Answers each step with the same, and notes it; or refuses it."""

    def __init__(self) -> None:
        self.steps: list[tuple[Any, ...]] = []
        self.refusal = ""

    def __getattr__(self, name: str) -> Any:
        def step(*told: Any) -> dict[str, Any]:
            if self.refusal:
                raise DraftRefused(self.refusal)
            self.steps.append((name, *told))
            return STATE

        return step


@pytest.fixture
def draft(plant: Any) -> Draft:
    plant.offered[DraftApi] = made = Draft()
    return made


@pytest.mark.parametrize("step", STEPS)
def test_each_step_reaches_the_draft_and_answers_its_state(web: Any, draft: Draft, step: str) -> None:
    body, told = STEPS[step]
    answer = web.post(f"/api/draft/{step}", json=body)
    assert (answer.status_code, answer.json()) == (200, STATE)
    assert draft.steps == [told]


def test_the_draft_is_looked_at(web: Any, draft: Draft) -> None:
    assert web.get("/api/draft").json() == STATE and draft.steps == [("state",)]


@pytest.mark.parametrize("step", ["", "/check", "/undo", "/keep", "/apply"])
def test_a_viewer_may_do_nothing_of_it(open_to_all: Any, draft: Draft, step: str) -> None:
    body = STEPS.get(step[1:], ({},))[0]
    method = "POST" if step else "GET"
    answer = open_to_all.client(token=Role.VIEWER).request(method, f"/api/draft{step}", json=body)
    assert answer.status_code == 403 and "operator" in answer.json()["sentence"] and draft.steps == []


def test_a_refusal_is_a_conflict_with_its_sentence(web: Any, draft: Draft) -> None:
    draft.refusal = "ben edits this draft"
    answer = web.post("/api/draft/undo", json=EDITOR)
    assert (answer.status_code, answer.json()["sentence"]) == (409, "ben edits this draft")


@pytest.mark.parametrize(
    ("step", "body"),
    [
        ("undo", {}),
        ("undo", {"editor": "short"}),
        ("undo", EDITOR | {"more": 1}),
        ("take", EDITOR | {"name": ""}),
        ("set", EDITOR | {"place": [], "value": 1}),
        ("set", EDITOR | {"place": ["a"]}),
        ("set", EDITOR | {"place": ["a"], "value": 1, "of": 1}),
        ("set", EDITOR | {"place": [True], "value": 1}),
        ("set", EDITOR | {"place": [-1], "value": 1}),
        ("set", EDITOR | {"place": ["a"] * 21, "value": 1}),
        ("keep", EDITOR | {"note": "x" * 201}),
    ],
)
def test_a_body_that_is_none_is_refused_with_what_is_wrong(
    web: Any, draft: Draft, step: str, body: dict[str, Any]
) -> None:
    answer = web.post(f"/api/draft/{step}", json=body)
    assert answer.status_code == 422 and ":" in answer.json()["sentence"] and draft.steps == []


def test_what_an_id_has_to_be_is_said_as_it_is(web: Any, draft: Draft) -> None:
    sentence = web.post("/api/draft/undo", json={"editor": "short"}).json()["sentence"]
    assert "[A-Za-z0-9_-]{8,64}" in sentence


def test_a_value_that_is_too_long_is_not_read(web: Any, draft: Draft) -> None:
    answer = web.post("/api/draft/set", json=EDITOR | {"place": ["a"], "value": "x" * 5000})
    assert answer.status_code == 413 and draft.steps == []


def test_the_shipped_plant_has_no_draft(web: Any, plant: Any) -> None:
    plant.offered.pop(DraftApi, None)
    answer = web.get("/api/draft")
    assert answer.status_code == 404 and "arboleda new" in answer.json()["sentence"]


def test_a_file_of_trees_is_read_and_may_be_as_large_as_one_that_is_drawn(web: Any, draft: Draft) -> None:
    assert web.get("/api/draft/trees", params={"file": "a.xml"}).status_code == 200
    text = "<!-- " + "x" * 200_000 + " -->"
    body = EDITOR | {"file": "a.xml", "text": text}
    assert web.post("/api/draft/set_trees", json=body).status_code == 200
    assert draft.steps == [("trees", "a.xml"), ("set_trees", "ana-12345", "a.xml", text)]
