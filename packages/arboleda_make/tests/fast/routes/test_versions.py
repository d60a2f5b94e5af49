"""The routes of the versions: who may, what they take, and what they answer."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.web.access.auth import Role
from arboleda_make.drafts.api import DraftRefused
from arboleda_make.versions.api import VersionsApi

LIST = {"at_work": {"number": None, "at": "2026"}, "versions": [], "cells": []}
LIST |= {"restart": {"by": "", "can": True}}
ANSWER = {"version": 3, "problems": [], "warnings": [], "cells": {"lab": "now"}, "restart": []}
BODY = {"name": "Ana"}


class Kept:
    """Versions that note what is put to work."""

    def __init__(self) -> None:
        self.put_to_work: list[tuple[int, str]] = []
        self.restarts: list[tuple[str, bool]] = []
        self.refusal = ""

    def listed(self) -> dict[str, Any]:
        return LIST

    def put(self, number: int, by: str) -> dict[str, Any]:
        if self.refusal:
            raise DraftRefused(self.refusal)
        self.put_to_work.append((number, by))
        return ANSWER

    def restart(self, by: str, *, wanted: bool) -> dict[str, Any]:
        self.restarts.append((by, wanted))
        return LIST


@pytest.fixture
def kept(plant: Any) -> Kept:
    plant.offered[VersionsApi] = made = Kept()
    return made


def test_they_are_listed_also_for_viewers(open_to_all: Any, kept: Kept) -> None:
    assert open_to_all.client(token=Role.VIEWER).get("/api/versions").json() == LIST


def test_one_is_put_to_work_by_somebody(web: Any, kept: Kept) -> None:
    answer = web.post("/api/versions/3/put", json=BODY)
    assert (answer.status_code, answer.json()) == (200, ANSWER) and kept.put_to_work == [(3, "Ana")]


def test_a_viewer_puts_none_to_work(open_to_all: Any, kept: Kept) -> None:
    answer = open_to_all.client(token=Role.VIEWER).post("/api/versions/3/put", json=BODY)
    assert answer.status_code == 403 and "operator" in answer.json()["sentence"] and kept.put_to_work == []


def test_a_restart_is_wanted_by_an_operator_and_called_off(web: Any, open_to_all: Any, kept: Kept) -> None:
    assert web.post("/api/versions/restart", json=BODY).json() == LIST
    assert web.post("/api/versions/restart", json=BODY | {"wanted": False}).status_code == 200
    assert web.post("/api/versions/restart", json=BODY | {"wanted": 1}).status_code == 422
    assert kept.restarts == [("Ana", True), ("Ana", False)]


def test_a_refusal_is_a_conflict_with_its_sentence(web: Any, kept: Kept) -> None:
    kept.refusal = "the files are as they are at work"
    answer = web.post("/api/versions/3/put", json=BODY)
    assert (answer.status_code, answer.json()["sentence"]) == (409, kept.refusal)


@pytest.mark.parametrize(
    ("number", "body"), [("0", BODY), ("x", BODY), ("3", {}), ("3", {"name": ""}), ("3", BODY | {"a": 1})]
)
def test_a_wrong_request_is_refused(web: Any, kept: Kept, number: str, body: dict[str, Any]) -> None:
    assert web.post(f"/api/versions/{number}/put", json=body).status_code == 422 and kept.put_to_work == []


def test_a_plant_without_a_file_has_none(web: Any, plant: Any) -> None:
    plant.offered.pop(VersionsApi, None)
    assert web.get("/api/versions").status_code == 404
