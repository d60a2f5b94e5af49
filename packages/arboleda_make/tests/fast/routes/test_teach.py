"""The routes of teaching: who may, what they take, and what they answer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from arboleda.web import limits
from arboleda.web.access.auth import Role
from arboleda_make.teaching.api import Along, Button, Target, TeachApi, TeachRefused

STATE = {"cell": "sis_a", "teaching": None, "refusal": None, "devices": [], "targets": [], "drafts": True}
PRESSED = {"teaching": None, "robot": {"name": "ra1"}}
MADE = {"at": [1.0, 2.0], "place": ["cells", "sis_a", "home"]}
BUTTON = {"session": 1, "number": 2, "robot": "ra1"}
TARGET = {"robot": "ra1", "target": "nest", "editor": "ana-12345", "name": "Ana"}


class Desk:
    """Answers with what was prepared, and notes what it was told; or refuses it."""

    def __init__(self) -> None:
        self.told: list[Any] = []
        self.refusal = ""

    def state(self, cell: str) -> dict[str, Any]:
        return self._note(cell, STATE)

    def press(self, cell: str, button: Button) -> dict[str, Any]:
        return self._note((cell, button), PRESSED)

    def here(self, cell: str, target: Target) -> dict[str, Any]:
        return self._note((cell, target), MADE)

    def _note(self, told: Any, answer: dict[str, Any]) -> dict[str, Any]:
        if self.refusal:
            raise TeachRefused(self.refusal)
        self.told.append(told)
        return answer


@pytest.fixture
def desk(plant: Any) -> Desk:
    plant.offered[TeachApi] = made = Desk()
    return made


def test_a_cell_is_looked_at(web: Any, desk: Desk) -> None:
    assert web.get("/api/teach/sis_a").json() == STATE and desk.told == ["sis_a"]


@pytest.mark.parametrize(
    ("told", "meant"),
    [
        ({"goal": [1.5, 2]}, {"goal": [1.5, 2.0]}),
        ({"goal": 4}, {"goal": 4}),
        ({"along": {"axis": "x", "mm": 1}}, {"along": Along(axis="x", mm=1.0)}),
        ({"verb": "close", "values": {"n": 3}}, {"verb": "close", "values": {"n": 3}}),
        ({"held": False}, {"held": False}),
    ],
)
def test_a_button_reaches_the_plant(web: Any, desk: Desk, told: Any, meant: Any) -> None:
    answer = web.post("/api/teach/sis_a/jog", json=BUTTON | told)
    assert (answer.status_code, answer.json()) == (200, PRESSED)
    assert desk.told == [("sis_a", Button(session=1, number=2, robot="ra1", **meant))]


@pytest.mark.parametrize(
    "told", [{}, {"goal": 1, "verb": "home"}, {"goal": "1"}, {"goal": 1, "number": -1}, {"more": 1}]
)
def test_any_other_button_is_wrong(web: Any, desk: Desk, told: Any) -> None:
    assert web.post("/api/teach/sis_a/jog", json=BUTTON | told).status_code == 422 and desk.told == []


def test_a_target_is_made(web: Any, desk: Desk) -> None:
    answer = web.post("/api/teach/sis_a/here", json=TARGET | {"approach_mm": 40})
    assert (answer.status_code, answer.json()) == (200, MADE)
    assert desk.told == [("sis_a", Target(**TARGET, approach_mm=40.0))]


def test_a_refusal_is_a_conflict_with_its_sentence(web: Any, desk: Desk) -> None:
    desk.refusal = "ra1 is offline"
    answer = web.post("/api/teach/sis_a/jog", json=BUTTON | {"goal": 1})
    assert (answer.status_code, answer.json()["sentence"]) == (409, "ra1 is offline")


@pytest.mark.parametrize("path", ["", "/jog", "/here"])
def test_a_viewer_teaches_nothing(open_to_all: Any, desk: Desk, path: str) -> None:
    method, body = ("POST" if path else "GET"), {"/jog": BUTTON | {"goal": 1}, "/here": TARGET}.get(path, {})
    answer = open_to_all.client(token=Role.VIEWER).request(method, f"/api/teach/sis_a{path}", json=body)
    assert answer.status_code == 403 and "operator" in answer.json()["sentence"] and desk.told == []


def test_buttons_have_a_rate_of_their_own(
    serve: Callable[..., Any], desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(limits, "CHANGE", (1e-9, 1))
    web = serve().client()
    answers = [web.post("/api/teach/sis_a/jog", json=BUTTON | {"goal": 1}).status_code for _ in range(3)]
    assert answers == [200] * 3
    assert [web.post("/api/plant/hold").status_code for _ in range(2)] == [200, 429]


def test_a_plant_that_is_not_taught_from_here_says_so(web: Any) -> None:
    assert web.get("/api/teach/sis_a").status_code == 404
