"""The routes of the draft as a plant: who may, what they take, and what they answer."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from arboleda.web.access.auth import Role
from arboleda_make.drafts.api import DraftRefused
from arboleda_make.editing.errors import EditError
from arboleda_make.trying.api import MakeApi

STATE = {"file": "plant.yaml", "editor": None, "changes": [], "waiting": [], "undo": 0, "redo": 0}
STATE |= {"values": {}}
CELLS = {"cells": [], "faults": [], "problems": ["plant.yaml:1:1: no"]}
CARRY = {"editor": "ana-12345", "cell": "lab", "recipe": "to_tray", "robot": "arm", "start": "a", "end": "b"}
FAULT = {"kind": "reboot", "at": 2.5, "seconds": 0.0, "target": "arm", "amount": 0.0, "word": "will"}
COPY = {"editor": "ana-12345", "cell": "lab", "recipe": "weigh", "name": "weigh_tree"}
DEVICE = {"cell": "lab", "role": "door", "kind": "gate", "driver": "modbus", "settings": {"host": "10.0.0.2"}}
DEVICE |= {"keys": {"evidence": "state"}}
DRIVER = {"name": "modbus", "about": "", "why_not": "", "keys": [{"name": "host", "form": "text"}]}
POSTS = {
    "carry": CARRY,
    "copy": COPY,
    "device": DEVICE | {"editor": "ana-12345"},
    "objections": DEVICE | {"role": "Not a name", "kind": ""},
    "remove": {"editor": "ana-12345", "cell": "lab", "role": "door"},
    "runs/reach": DEVICE,
    "drawn/check": {"cell": "lab", "text": "<root/>"},
    "runs/try": {},
    "runs/try/end": {},
}


class Make:
    """Answers what a bench answers, and notes what it was asked."""

    def __init__(self, file: Path) -> None:
        self.asked: list[tuple[Any, ...]] = []
        self.file: Path | None = file

    def cells(self) -> dict[str, Any]:
        return CELLS

    def shown(self, cell: str, recipe: str) -> str:
        self.asked.append((cell, recipe))
        return "<root/>"

    def carry(self, editor: str, recipe: str, way: dict[str, str]) -> dict[str, Any]:
        self.asked.append((editor, recipe, way))
        if recipe == "known":
            raise DraftRefused("'known.xml' is there already")
        return STATE

    def copy(self, editor: str, cell: str, recipe: str, name: str) -> dict[str, Any]:
        self.asked.append((editor, cell, recipe, name))
        if recipe == "tour":
            raise EditError("arm.tour cannot be drawn: no node in XML does this")
        return STATE

    def drivers(self, language: str) -> list[dict[str, Any]]:
        self.asked.append((language,))
        return [DRIVER]

    def add_device(self, editor: str, device: dict[str, Any]) -> dict[str, Any]:
        self.asked.append((editor, device))
        return STATE

    def objections(self, device: dict[str, Any]) -> list[dict[str, Any]]:
        self.asked.append((device,))
        return [{"place": "kinds.gate", "sentence": "kinds.gate: no"}]

    def remove(self, editor: str, cell: str, role: str) -> dict[str, Any]:
        self.asked.append((editor, cell, role))
        return STATE

    def reach(self, device: dict[str, Any]) -> dict[str, Any]:
        self.asked.append(("reach", device))
        return {"state": "running"}

    def begin(self, what: str, wanted: dict[str, Any]) -> dict[str, Any]:
        self.asked.append((what, wanted))
        return {"state": "running"}

    def run(self, what: str) -> dict[str, Any]:
        return {"state": "running", "sentence": "1 of 9", "doing": "proving", "done": 1, "total": 9}

    def end(self, what: str) -> dict[str, Any]:
        return {"state": "stopped"}

    def result(self, what: str) -> Path | None:
        return self.file


@pytest.fixture
def make(plant: Any, tmp_path: Path) -> Make:
    (tmp_path / "result.json").write_text('{"runs": 3}')
    plant.offered[MakeApi] = made = Make(tmp_path / "result.json")
    return made


def test_cells_are_told_with_their_problems(web: Any, make: Make) -> None:
    assert web.get("/api/make/cells").json() == CELLS


def test_the_tree_of_a_recipe_is_xml(web: Any, make: Make) -> None:
    answer = web.get("/api/make/recipe?cell=lab&recipe=weigh")
    assert (answer.text, answer.headers["content-type"]) == ("<root/>", "application/xml")
    assert make.asked == [("lab", "weigh")]


def test_a_part_is_carried_by_a_new_recipe(web: Any, make: Make) -> None:
    assert web.post("/api/make/carry", json=CARRY).json() == STATE
    way = {"cell": "lab", "robot": "arm", "start": "a", "end": "b"}
    assert make.asked == [("ana-12345", "to_tray", way)]


def test_a_recipe_in_python_is_copied_or_refused_with_why(web: Any, make: Make) -> None:
    assert web.post("/api/make/copy", json=COPY).json() == STATE
    assert make.asked == [("ana-12345", "lab", "weigh", "weigh_tree")]
    answer = web.post("/api/make/copy", json=COPY | {"recipe": "tour"})
    assert answer.status_code == 422 and "arm.tour cannot be drawn" in answer.json()["sentence"]
    assert web.post("/api/make/copy", json=COPY | {"name": "../x"}).status_code == 422


@pytest.mark.parametrize("name", ["", "To Tray", "9a", "x" * 41])
def test_what_is_no_name_of_a_recipe_is_refused(web: Any, make: Make, name: str) -> None:
    answer = web.post("/api/make/carry", json=CARRY | {"recipe": name})
    assert answer.status_code == 422 and "recipe" in answer.json()["sentence"] and make.asked == []


def test_a_recipe_that_is_there_is_a_conflict(web: Any, make: Make) -> None:
    answer = web.post("/api/make/carry", json=CARRY | {"recipe": "known"})
    assert answer.status_code == 409 and "already" in answer.json()["sentence"]


def test_a_tryout_begins_with_its_faults_and_says_how_far_it_is(web: Any, make: Make) -> None:
    begun = web.post("/api/make/runs/try", json={"task": "lab", "faults": [FAULT]}).json()
    assert begun["state"] == "running" and make.asked[0][1]["faults"] == [FAULT]
    assert web.get("/api/make/runs/try").json()["done"] == 1
    assert web.post("/api/make/runs/try/end").json()["state"] == "stopped"
    assert web.get("/api/make/runs/try/result").json() == {"runs": 3}


def test_drivers_have_a_form_in_the_language_of_who_asks(web: Any, make: Make) -> None:
    assert web.get("/api/make/drivers?language=es").json() == [DRIVER]
    assert make.asked == [("es",)]


def test_a_device_is_added_with_its_driver(web: Any, make: Make) -> None:
    assert web.post("/api/make/device", json=POSTS["device"]).json() == STATE
    [(editor, device)] = make.asked
    assert editor == "ana-12345" and DEVICE.items() <= device.items() and device["declared"] is None


def test_what_is_no_name_yet_is_judged_too(web: Any, make: Make) -> None:
    assert web.post("/api/make/objections", json=POSTS["objections"]).json()[0]["place"] == "kinds.gate"
    assert make.asked == [(POSTS["objections"] | {"declared": None},)]


def test_a_device_is_taken_away_or_a_whole_cell(web: Any, make: Make) -> None:
    assert web.post("/api/make/remove", json=POSTS["remove"]).json() == STATE
    assert web.post("/api/make/remove", json={"editor": "ana-12345", "cell": "lab"}).json() == STATE
    assert make.asked == [("ana-12345", "lab", "door"), ("ana-12345", "lab", "")]


def test_a_device_is_listened_to_without_an_editor(web: Any, make: Make) -> None:
    declared = {"facts": {"lit": "bool"}, "verbs": {}}
    assert web.post("/api/make/runs/reach", json=DEVICE | {"declared": declared}).json()["state"] == "running"
    assert make.asked == [("reach", DEVICE | {"declared": declared})]
    assert web.post("/api/make/runs/reach/end").json()["state"] == "stopped"


@pytest.mark.parametrize(
    "wrong",
    [{"role": "The Door"}, {"role": ""}, {"settings": {"host": 3}}, {"settings": {"host": "x" * 20_001}}],
)
def test_what_is_no_device_is_refused(web: Any, make: Make, wrong: dict[str, Any]) -> None:
    for path in ("device", "runs/reach"):
        answer = web.post(f"/api/make/{path}", json=POSTS[path] | wrong)
        assert answer.status_code == 422 and next(iter(wrong)) in answer.json()["sentence"]
    assert make.asked == []


@pytest.mark.parametrize(
    "body", [{"budget_s": 0}, {"budget_s": 601}, {"faults": [FAULT] * 3}, {"task": "x" * 201}, {"more": 1}]
)
def test_a_wish_beyond_its_limits_is_refused(web: Any, make: Make, body: dict[str, Any]) -> None:
    assert web.post("/api/make/runs/prove", json=body).status_code == 422 and make.asked == []


def test_only_what_there_is_can_be_run(web: Any, make: Make) -> None:
    assert web.get("/api/make/runs/rm").status_code == 422


def test_nothing_came_of_it_yet(web: Any, make: Make) -> None:
    make.file = None
    assert web.get("/api/make/runs/prove/result").status_code == 404


@pytest.mark.parametrize(
    "path", ["cells", "recipe?cell=a&recipe=b", "palette?cell=a", "drivers", "runs/try", "runs/try/result"]
)
def test_a_viewer_may_not_look(open_to_all: Any, make: Make, path: str) -> None:
    assert open_to_all.client(token=Role.VIEWER).get(f"/api/make/{path}").status_code == 403


@pytest.mark.parametrize("path", POSTS)
def test_a_viewer_may_do_nothing(open_to_all: Any, make: Make, path: str) -> None:
    answer = open_to_all.client(token=Role.VIEWER).post(f"/api/make/{path}", json=POSTS[path])
    assert answer.status_code == 403 and make.asked == []


def test_the_shipped_plant_has_none(web: Any, plant: Any) -> None:
    plant.offered.pop(MakeApi, None)
    answer = web.get("/api/make/cells")
    assert answer.status_code == 404 and "arboleda new" in answer.json()["sentence"]
